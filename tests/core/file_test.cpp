#include "carve/core/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "carve/core/error.h"
#include "temporary_folder.h"

namespace carve {
namespace {
namespace fs = std::filesystem;

std::size_t files_in(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

TEST(WriteFile, ReadsBack) {
  const TemporaryFolder folder;
  write_file(folder / "a", [](std::ostream& out) { out << "one\0two" << 1.5; });
  EXPECT_EQ(read_file(folder / "a"), std::string("one1.5"));
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, AWriterThatThrowsLeavesTheOldFile) {
  const TemporaryFolder folder;
  write_file(folder / "a", [](std::ostream& out) { out << "old"; });
  EXPECT_THROW(write_file(folder / "a",
                          [](std::ostream& out) {
                            out << "new";
                            throw std::runtime_error("no");
                          }),
               std::runtime_error);
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, AFullDiskLeavesTheOldFile) {
  const TemporaryFolder folder;
  write_file(folder / "a", [](std::ostream& out) { out << "old"; });
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto write_much = [&] {
    write_file(folder / "a", [](std::ostream& out) { out << std::string(1 << 20, 'x'); });
  };
  EXPECT_THROW(write_much(), IoError);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(read_file(folder / "a"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, DevicesAndMissingFoldersAreRefused) {
  const auto nothing = [](std::ostream&) {};
  EXPECT_THROW(write_file("/dev/full", nothing), IoError);
  EXPECT_THROW(write_file("/no/such/folder/a", nothing), IoError);
}

TEST(ReadFile, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_file(folder / "missing"), IoError);
  EXPECT_THROW(read_file(folder.path()), IoError);
  write_file(folder / "a", [](std::ostream& out) { out << "12345"; });
  EXPECT_THROW(read_file(folder / "a", 4), IoError);
  EXPECT_EQ(read_file(folder / "a", 5), "12345");
}

}  // namespace
}  // namespace carve
