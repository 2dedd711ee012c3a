// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "landmarks/semantic_map.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/global/constellation.hpp"
#include "localization/global/skyline.hpp"
#include "localization/localizer.hpp"
#include "localization/motion_model.hpp"
#include "localization/sighting.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/localization/localize.hpp"

/// \page localization_header waymark/localization.hpp
/// The pose of a robot from a map and what its sensors see.
///
/// Localize a log with localize() and compare the track with the truth, as the commands do:
/// \snippet snippets/localization.cpp localize
/// List methods and settings with localize_methods() and localize_settings(), and errors over time with
/// track_errors():
/// \snippet snippets/localization.cpp methods
/// Use a filter in a robot of your own. The map:
/// \snippet snippets/localization.cpp map
/// What the robot sees:
/// \snippet snippets/localization.cpp sighting
/// Make an ExtendedKalman, UnscentedKalman, ParticleFilter or DeadReckoning:
/// \snippet snippets/localization.cpp filters
/// Each is a Localizer, which predicts and updates:
/// \snippet snippets/localization.cpp filter
/// Make motions of a car, or of measured steps:
/// \snippet snippets/localization.cpp motion
/// Compute single steps of a filter of your own with predict_pose(), ukf_predict() and ekf_update():
/// \snippet snippets/localization.cpp step
/// Find a robot anywhere in a map with ConstellationIndex:
/// \snippet snippets/localization.cpp constellation
/// Index a map around a body:
/// \snippet snippets/localization.cpp body
/// Find it by its horizon with find_by_skyline():
/// \snippet snippets/localization.cpp skyline
/// Compute a pose from known summits with resection(), and lines of sight with clears_terrain():
/// \snippet snippets/localization.cpp resection

/// \example snippets/localization.cpp
/// The excerpts of \ref localization_header as a program.
