// SPDX-License-Identifier: BSD-3-Clause
// Chunk records as the map file stores them: compressed.
#pragma once

#include <zstd.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace csom::detail {

/// Compresses and decompresses records with zstd, reusing its buffers.
class ChunkCodec {
 public:
  ChunkCodec();

  /// Valid until the next call.
  std::string_view compress(const void* record, std::size_t size);
  /// Valid until the next call. Throws std::runtime_error with the reason if the bytes are no zstd
  /// frame of at most `max_size` bytes.
  std::string_view decompress(std::string_view frame, std::size_t max_size);

 private:
  struct Deleter {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  std::unique_ptr<ZSTD_CCtx, Deleter> compressor_;
  std::unique_ptr<ZSTD_DCtx, Deleter> decompressor_;
  std::string buffer_;
};

}  // namespace csom::detail
