// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
namespace waymark::pipeline {

/// Returns the shift of log odds that adapts a classifier from its training prior `training_prior` to the
/// prior of this image (Saerens, Latinne & Decaestecker 2002).
/// - The prior is estimated by expectation maximisation over the candidates, kept within 2 to 98 %. Four
///   pseudo-candidates of the training prior regularise it.
/// - Annotators and terrain differ in prevalence, and log odds are imperfect; callers apply a part of the
///   shift.
/// - O(n), at most 100 rounds.
double prior_shift(std::span<const double> log_odds, double training_prior);

}  // namespace waymark::pipeline
