#include "run/hash.h"

#include <xxhash.h>

#include <cstdio>
#include <new>

#include "carve/core/file.h"

namespace carve::experiments {
namespace {
XXH3_state_t* state(void* pointer) { return static_cast<XXH3_state_t*>(pointer); }
}  // namespace

Hash::Hash() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_128bits_reset(state(state_));
}
Hash::~Hash() { XXH3_freeState(state(state_)); }

Hash& Hash::add(std::string_view bytes) {
  const std::uint64_t length = bytes.size();
  XXH3_128bits_update(state(state_), &length, sizeof length);
  XXH3_128bits_update(state(state_), bytes.data(), bytes.size());
  return *this;
}

std::string Hash::hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state(state_));
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

const std::string& program_hash() {
  static const std::string hash = Hash().add(read_file(std::filesystem::canonical("/proc/self/exe"))).hex();
  return hash;
}

}  // namespace carve::experiments
