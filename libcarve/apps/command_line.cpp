#include "apps/command_line.h"

#include <iostream>
#include <new>

#include "carve/core/error.h"
#include "carve/core/pages.h"
#include "carve/core/parallel.h"

namespace carve {
namespace {

int complain(const CLI::App& app, const char* what, ExitCode code) {
  std::cerr << app.get_name() << ": " << what << '\n';
  return code;
}

std::string flag_of(const Field& field) {
  std::string flag = "--" + field.name;
  if (flag.ends_with(".arm")) flag.resize(flag.size() - 4);
  for (char& c : flag)
    if (c == '.' || c == '_') c = '-';
  return flag;
}

}  // namespace

void add_flags(CLI::App& app, std::span<const Field> fields) {
  for (const Field& field : fields) {
    const std::string flag = flag_of(field);
    const auto set = [field, flag](const std::string& text) {
      try {
        field.set(text);
      } catch (const std::invalid_argument& error) {
        throw CLI::ValidationError(error.what());
      }
    };
    // --refine remesh decimate: a stage's arms are several words, or one with commas.
    const bool several = field.kind == Field::Kind::list && field.name.ends_with(".arm");
    const auto set_several = [set](const std::vector<std::string>& words) {
      std::string text;
      for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
      set(text);
    };
    CLI::Option* const option = several
                                    ? app.add_option_function<std::vector<std::string>>(flag, set_several, field.help)
                                    : app.add_option_function<std::string>(flag, set, field.help);
    option->type_name(field.range)
        ->default_str(field.get())
        ->group(field.name.find('.') == std::string::npos ? "Options" : field.name.substr(0, field.name.find('.')))
        ->trigger_on_parse();
  }
}

void add_threads_flag(CLI::App& app) {
  app.add_option_function<int>(
         "--threads", [](const int& threads) { set_thread_count(threads); },
         "threads to use; 0 = all cores; never changes the result")
      ->check(CLI::Range(0, 1024))
      ->default_str("0");
}

void add_reference_flag(CLI::App& app, std::filesystem::path& reference) {
  app.add_option("--reference", reference, "the mesh they are measured against")->required()->type_name("FILE");
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& work) {
  keep_freed_memory();
  try {
    app.parse(argc, argv);
    return work();
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return complain(app, (std::string(error.what()) + " (see --help)").c_str(), kBadInput);
  } catch (const IoError& error) {
    return complain(app, error.what(), error.side() == IoError::Side::input ? kBadInput : kFailed);
  } catch (const std::invalid_argument& error) {
    return complain(app, error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return complain(app, "not enough memory for this input and these options", kFailed);
  } catch (const std::exception& error) {
    return complain(app, error.what(), kFailed);
  }
}

}  // namespace carve
