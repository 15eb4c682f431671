// SPDX-License-Identifier: MIT
#include "encoder/product/open_pack.hpp"

#include <memory>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/pack/shard.hpp"

namespace microtin::product {

OpenPack open_pack(const std::string& path) {
  std::unique_ptr<ByteSource> bytes = open_file(path);
  refuse_shard(path, *bytes);
  return with_file_context(path, [&] {
    if (!is_pack(*bytes)) throw Error("is not a pack");
    const ByteSource& same = *bytes;
    PackFile file(std::move(bytes), PackFile::Index::kLater);
    file.expect_index();
    const uint32_t header_bytes = pack_index_start(file.header());
    return OpenPack{bytes_at(same, 0, header_bytes), std::move(file)};
  });
}

}  // namespace microtin::product
