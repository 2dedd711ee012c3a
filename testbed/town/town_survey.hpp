// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <span>
#include "testbed/laser_return.hpp"
#include "testbed/town/town.hpp"
namespace waymark::testbed {

/// Simulates an airborne laser survey of a street: pulses slanted by up to 15 degrees across it, Poisson in
/// squares of 1 m.
/// - A pulse returns from the highest of roof, wall, post, car's side and ground; eaves hide the walls below.
/// - A crown returns it after an exponential depth. It continues with probability 0.55, up to four returns.
/// - Ground has class 2, all else 1. The whole survey is shifted by a normal error of `survey_shift_sd`.
/// - `take` receives the returns by rows of squares.
/// Deterministic for a town and a seed. O(pulses x walls), some microseconds per pulse.
void survey_town(const Town& town, const StreetModel& model, std::uint64_t seed,
                 const std::function<void(std::span<const LaserReturn>)>& take);

}  // namespace waymark::testbed
