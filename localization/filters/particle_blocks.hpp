// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
namespace waymark::localization {

/// Calls work(first, last) for blocks of 512 of `count` particles, on several threads (0: all) if that
/// pays. The blocks are the same for any number of threads; results must not depend on their order.
void for_each_block(std::size_t count, std::int64_t threads,
                    const std::function<void(std::size_t, std::size_t)>& work);

}  // namespace waymark::localization
