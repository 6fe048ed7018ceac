#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "carve/core/vector.h"

namespace carve {

/// A binary PLY cloud, read piece by piece: in the memory of a piece, whatever the size of the file.
class PlyCloud {
 public:
  /// Nothing if the file is no binary PLY that holds vertices without lists and no faces: read_mesh is for the others.
  /// \throws IoError as read_mesh: missing, a wrong header, more points than the file can hold
  static std::optional<PlyCloud> open(const std::filesystem::path& path);
  ~PlyCloud();
  PlyCloud(PlyCloud&&) noexcept;

  std::size_t size() const;  // points in the file
  /// The next `most` points, or what is left of them. \throws IoError: a coordinate that is not finite, read error
  std::vector<Vec3> next(std::size_t most);

 private:
  struct State;
  explicit PlyCloud(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace carve
