// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/particle_blocks.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace waymark::localization {

void for_each_block(std::size_t count, std::int64_t threads,
                    const std::function<void(std::size_t, std::size_t)>& work) {
  constexpr std::size_t kBlock = 512;
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  const auto block = [&](std::size_t b) { work(b * kBlock, std::min(count, (b + 1) * kBlock)); };
  if (blocks < 4 || threads == 1) {
    for (std::size_t b = 0; b < blocks; ++b) block(b);
    return;
  }
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, blocks, block); };
  if (threads == 0) return all();
  tbb::task_arena(static_cast<int>(threads)).execute(all);
}

}  // namespace waymark::localization
