// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/MapFile.h>
#include <xxhash.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>

namespace csom {

namespace {

/// XXH3 over a sequence of pieces.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_64bits_reset(state_.get());
  }
  void add(const void* bytes, std::size_t size) { XXH3_64bits_update(state_.get(), bytes, size); }
  template <class Number>
  void add(Number number) {
    add(&number, sizeof number);
  }
  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

}  // namespace

std::string mapDigest(const SemanticMap& map) {
  Hasher hasher;
  hasher.add(map.options().resolution);
  hasher.add(static_cast<std::int32_t>(map.options().number_of_classes));
  hasher.add(map.options().prior);
  for (const auto& [index, chunk] : map.chunks().sorted()) {
    hasher.add(index.x);
    hasher.add(index.y);
    hasher.add(index.z);
    hasher.add(chunk->record(), chunk->recordSize());
  }
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx",
                static_cast<unsigned long long>(hasher.value()));
  return text.data();
}

}  // namespace csom
