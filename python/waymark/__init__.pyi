# SPDX-License-Identifier: Apache-2.0
# Written by scripts/update-python from the declarations of the C++ library.
import os
from collections.abc import Iterator, Sequence
from typing import Any, TypedDict

import numpy as np

from . import stages as stages

__version__: str
_Path = str | os.PathLike[str]

class BeaconsSettings(TypedDict, total=False):
    """Settings of localize(method="beacons")."""
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    range_offset_sd: float  # Metres by which all ranges to one beacon may be off over the drive; 0: not at all
    range_outliers: float  # Fraction of echoes among ranges to beacons whose position is not known yet
    slant_ranges: bool  # Ranges are slant: beacons are at their height in the map, the antenna at antenna_height
    antenna_height: float  # Height of the antenna in the heights of the map, metres

class EkfSettings(TypedDict, total=False):
    """Settings of localize(method="ekf")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    lost_after: float  # Consecutive sets of sightings without a match before the filter searches
    search_growth: float  # Growth of the standard deviations per set while searching
    hypotheses: float  # Largest number of Gaussians
    min_weight: float  # Weight, relative to the best, below which a Gaussian is dropped (formerly least_weight)
    merge: float  # Squared Mahalanobis distance below which two Gaussians are merged
    split_yaw: float  # Standard deviation of yaw, radians, above which a Gaussian is split
    error_correlation_distance: float  # Metres driven until the map error of a landmark not seen meanwhile counts as new; 0: at once (formerly same_error)
    expect_unseen: bool  # likelihood: unseen landmarks in view count against a pose
    detection: float  # Probability that a landmark in view is seen
    view_range: float  # expect_unseen: range of the sensor, metres
    view_angle: float  # expect_unseen: the sensor's whole field of view, radians
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

class GlobalSettings(TypedDict, total=False):
    """Settings of localize(method="global")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    particles: float  # Particles while the pose is known
    search_particles: float  # Particles during global localization
    adaptive: bool  # Use as many particles as their spread needs (KLD sampling)
    kld_error: float  # Error bound of KLD sampling
    resample_below: float  # Resample if fewer than this fraction of the particles are effective
    recovery: bool  # Draw new poses when the likelihood of sightings falls
    recovery_slow: float  # Decay of the long-term mean likelihood, per set
    recovery_fast: float  # Decay of the short-term mean likelihood, per set
    weights: str  # Weights of particles: likelihood, or eqs. 12-14 of the paper
    temper: float  # Exponent of each likelihood; below 1 if errors of successive sightings are correlated
    particle_gate: float  # Probability that a right pairing passes
    unmatched_cost: float  # paper: cost of a sighting without landmark; negative: the gate
    expect_unseen: bool  # likelihood: unseen landmarks in view count against a pose
    detection: float  # Probability that a landmark in view is seen
    view_range: float  # expect_unseen: range of the sensor, metres
    view_angle: float  # expect_unseen: the sensor's whole field of view, radians
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

class GraphSettings(TypedDict, total=False):
    """Settings of localize(method="graph")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    graph_block: float  # Poses added between two optimisations of a graph; 0: all at once
    graph_iterations: float  # Largest number of iterations of the last optimisation
    graph_kernel: str  # Robust kernel of sightings and loops; auto: none for graph files, huber for logs
    graph_kernel_width: float  # Standard deviations from which the kernel reduces an error's weight
    slam_match: float  # Squared Mahalanobis distance up to which a sighting matches a landmark
    slam_new_landmark: float  # Squared Mahalanobis distance beyond which a sighting is a new landmark (formerly slam_fresh)
    slam_min_spacing: float  # Smallest distance between two landmarks, metres (formerly slam_nearest)
    slam_range: float  # Largest range of sightings, metres
    slam_seen: float  # Log odds of existence that a match adds
    slam_unseen: float  # Log odds of existence that a missed detection adds
    slam_confirmed: float  # Log odds from which a landmark is written to a map
    slam_dropped: float  # Log odds below which a landmark is removed
    slam_view: float  # Radians to each side where sightings are expected
    slam_margin: float  # Metres driven between two updates of the landmarks out of sight
    slam_feature_tolerance: float  # Relative standard deviation between two sightings of a landmark
    slam_feature_limit: float  # Squared standard deviations by which a feature may differ
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

class OdometrySettings(TypedDict, total=False):
    """Settings of localize(method="odometry")."""
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off

class PfSettings(TypedDict, total=False):
    """Settings of localize(method="pf")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    particles: float  # Particles while the pose is known
    search_particles: float  # Particles during global localization
    adaptive: bool  # Use as many particles as their spread needs (KLD sampling)
    kld_error: float  # Error bound of KLD sampling
    resample_below: float  # Resample if fewer than this fraction of the particles are effective
    recovery: bool  # Draw new poses when the likelihood of sightings falls
    recovery_slow: float  # Decay of the long-term mean likelihood, per set
    recovery_fast: float  # Decay of the short-term mean likelihood, per set
    weights: str  # Weights of particles: likelihood, or eqs. 12-14 of the paper
    temper: float  # Exponent of each likelihood; below 1 if errors of successive sightings are correlated
    particle_gate: float  # Probability that a right pairing passes
    unmatched_cost: float  # paper: cost of a sighting without landmark; negative: the gate
    expect_unseen: bool  # likelihood: unseen landmarks in view count against a pose
    detection: float  # Probability that a landmark in view is seen
    view_range: float  # expect_unseen: range of the sensor, metres
    view_angle: float  # expect_unseen: the sensor's whole field of view, radians
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

class SlamSettings(TypedDict, total=False):
    """Settings of localize(method="slam")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    slam_match: float  # Squared Mahalanobis distance up to which a sighting matches a landmark
    slam_new_landmark: float  # Squared Mahalanobis distance beyond which a sighting is a new landmark (formerly slam_fresh)
    slam_min_spacing: float  # Smallest distance between two landmarks, metres (formerly slam_nearest)
    slam_range: float  # Largest range of sightings, metres
    slam_seen: float  # Log odds of existence that a match adds
    slam_unseen: float  # Log odds of existence that a missed detection adds
    slam_confirmed: float  # Log odds from which a landmark is written to a map
    slam_dropped: float  # Log odds below which a landmark is removed
    slam_view: float  # Radians to each side where sightings are expected
    slam_margin: float  # Metres driven between two updates of the landmarks out of sight
    slam_feature_tolerance: float  # Relative standard deviation between two sightings of a landmark
    slam_feature_limit: float  # Squared standard deviations by which a feature may differ
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

class UkfSettings(TypedDict, total=False):
    """Settings of localize(method="ukf")."""
    distance: str  # Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper
    association: str  # Data association of the sightings of one set
    gate: float  # Probability that a right pairing passes
    certainty: float  # joint: pairings less probable are rejected as ambiguous
    bearing_certainty: float  # joint: the same for sightings without a range or a bearing, if it is more
    ambiguity: float  # Other associations: lead in squared distance a landmark needs over the next
    feature_tolerance: float  # Fraction of a feature's value by which two sensors may disagree
    feature_limit: float  # Squared standard deviations by which one feature may differ
    alpha: str  # Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from the landmark types
    clutter: float  # Least density of sightings without a landmark, per metre of range and radian of bearing
    learn_clutter: bool  # Estimate the density of sightings without a landmark over the drive
    bearing_reach: float  # Largest range of a sighting without range, metres; 0: that of its landmark type, or of a sensor that measures no ranges
    node_limit: float  # Largest number of nodes of a joint search
    quality: str  # Use the probability that a landmark exists as prior of its pairings, or divide its noise by eq. 8 of the paper
    quality_floor: float  # Smallest quality that the noise of a landmark is divided by; 1 turns quality off
    use_terrain: bool  # With --dem: landmarks that the terrain hides from the sensor are no candidates
    use_identities: bool  # Use the identities of landmarks in the log
    lost_after: float  # Consecutive sets of sightings without a match before the filter searches
    search_growth: float  # Growth of the standard deviations per set while searching
    hypotheses: float  # Largest number of Gaussians
    min_weight: float  # Weight, relative to the best, below which a Gaussian is dropped (formerly least_weight)
    merge: float  # Squared Mahalanobis distance below which two Gaussians are merged
    split_yaw: float  # Standard deviation of yaw, radians, above which a Gaussian is split
    error_correlation_distance: float  # Metres driven until the map error of a landmark not seen meanwhile counts as new; 0: at once (formerly same_error)
    expect_unseen: bool  # likelihood: unseen landmarks in view count against a pose
    detection: float  # Probability that a landmark in view is seen
    view_range: float  # expect_unseen: range of the sensor, metres
    view_angle: float  # expect_unseen: the sensor's whole field of view, radians
    along_per_metre: float  # Variance forward per metre driven, m^2/m
    across_per_metre: float  # Variance sideways per metre driven, m^2/m
    yaw_per_metre: float  # Variance of yaw per metre driven, rad^2/m
    yaw_per_radian: float  # Variance of yaw per radian turned, rad^2/rad
    position_per_second: float  # Variance of each coordinate per second, m^2/s
    yaw_per_second: float  # Variance of yaw per second, rad^2/s
    scale_sd: float  # Standard deviation of the relative error of distances that lasts the drive
    slip_sd: float  # Standard deviation of the relative error of distances that lasts drift_distance
    sideways_sd: float  # Standard deviation of metres sideways per metre driven, lasting drift_distance
    drift_distance: float  # Metres driven until slip and sideways drift have fallen to 1/e
    yaw_rate_sd: float  # Standard deviation of the bias of the turn rate, rad/s, that lasts the drive
    curvature_sd: float  # Standard deviation of yaw per metre driven, rad/m, that lasts the drive
    map_shift_sd: float  # Standard deviation, metres, of a shift that neighbouring landmarks share; negative: of imported maps the part of the stated accuracy that sightings do not show, of others none
    map_shift_distance: float  # Metres driven until the shift of the map has fallen to 1/e
    mount_sd: float  # Standard deviation, metres, of the sensors' place on the robot, forward and left
    mount_yaw_sd: float  # Standard deviation, radians, of the sensors' direction on the robot
    max_hold: float  # Seconds a speed holds without a new reading; then the robot stands (formerly longest_hold)
    use_fixes: bool  # Use the GNSS and compass readings of the log
    wheelbase: float  # Metres between front and rear wheels on the DEM
    track_width: float  # Metres between left and right wheels on the DEM
    sensor_noise: float  # Factor on the standard deviations of ranges and bearings in the log
    error_memory: float  # Factor on the correlation times of sensor errors in the log; 0: independent errors
    scans: str  # Detectors of landmarks in laser scans, separated by commas: doors, pillars, poles, reflectors, rocks, stems, wall_lines, walls; auto: those whose types have landmarks in the map; without a map walls if they fill the scans, else rocks
    scan_features: bool  # Use the diameters, radii and angles measured in scans
    sensor_height: float  # With --dem: height of the sensor above the ground, metres, for occlusion
    landmark_height: float  # With --dem: height of a landmark that must be visible, metres
    line_of_sight_step: float  # With --dem: metres between terrain samples along a line of sight (formerly sight_step)
    start_sd: float  # Metres by which the start may be off
    start_yaw_sd: float  # Radians by which the heading of the start may be off
    neighbours: float  # Nearest landmarks that make triangles with each one
    constellation_sigmas: float  # Standard deviations by which lengths and positions may differ
    false_alarms: float  # Largest expected number of chance poses of the whole map for an accepted fix
    lead: float  # Factor by which the best pose must be less probable by chance than the next
    min_matches: float  # Smallest number of matched sightings of a fix (formerly least_matches)
    max_tried: float  # Largest number of poses to fit (formerly most_tried)
    refraction: float  # Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth
    eye: float  # Skyline: height of the camera above the ground, metres
    skyline_reach: float  # Skyline: distance of the farthest summit, metres
    skyline_step: float  # Skyline: metres between the positions of the coarse grid
    summit_height_sd: float  # Skyline: error of the heights of summits and terrain, metres
    summit_position_sd: float  # Skyline: error of the positions of summits, metres (formerly summit_place_sd)

_Settings = BeaconsSettings | EkfSettings | GlobalSettings | GraphSettings | OdometrySettings | PfSettings | SlamSettings | UkfSettings | dict[str, Any] | None

class Error(RuntimeError):
    """A problem that the caller can fix. str() is the text that the program prints.
    
    problem: one line; where: file, option or position, may be empty; hint: what to do, may be empty;
    exit_code: that of the program."""
    problem: str
    where: str
    hint: str
    exit_code: int

class UsageError(Error, ValueError):
    """A wrong argument, option or job; exit code 2."""

class EnvironmentError(Error):
    """Missing library data, memory or permissions; exit code 1."""

class Feature:
    """A feature of a landmark type. Values outside [min, max] are implausible."""
    name: str
    unit: str
    scale: str
    min: float
    max: float
    summary: str

class InputError(Error):
    """A missing, damaged or unsuitable file; exit code 1."""

class LandmarkType:
    """A landmark type of a map: its features, and (name, unit, summary) of every column."""
    name: str
    summary: str
    count: int
    colour: str
    features: tuple
    columns: tuple

class Localization:
    """The localization of a log. Iterating yields an estimate (a record) per event while the log plays.
    
    track: all estimates as a structured array; settings: every setting of the method with its effect, as text. Both
    wait until the log has ended. Leaving the loop early and calling close() stops the work."""
    def __iter__(self) -> Iterator[np.void]:
        """Continues where an earlier loop was left."""
        ...
    @property
    def track(self) -> np.ndarray:
        """"""
        ...

    @property
    def settings(self) -> str:
        """"""
        ...

    def close(self) -> None:
        """Stops the localization."""
        ...

class Map:
    """A map file, opened for reading. The file is not changed, and nothing of it stays open."""
    path: str
    crs: str
    crs_name: str
    is_local: bool
    schema_version: int
    types: dict[str, LandmarkType]
    def __len__(self) -> int:
        """"""
        ...
    def __getitem__(self, type: Any) -> np.ndarray:
        """"""
        ...
    def __iter__(self) -> Iterator[str]:
        """Yields the names of the types that the map has landmarks of."""
        ...
    def __contains__(self, type: Any) -> bool:
        """Whether the map has landmarks of a type."""
        ...
    def query(self, types: Any = ..., *, bbox: Sequence[Any] | _Path = ..., aoi: _Path = ..., near: Sequence[Any] | _Path = ..., nearest: Sequence[Any] | _Path = ..., min: Sequence[Any] | _Path = ..., max: Sequence[Any] | _Path = ..., crs: _Path = ..., sensor: _Path = ..., min_confidence: float = ..., min_quality: float = ..., largest: _Path = ..., limit: int = ..., **conditions: Any) -> dict[str, np.ndarray]:
        """Returns a structured array per type: {"rock": array, ...}.

        min_FEATURE and max_FEATURE bound any number of the landmarks: min_prominence=300.

        Keywords:
            bbox: min_x, min_y, max_x, max_y
            aoi: file of polygons in any CRS of the body; empty: everywhere
            near: x, y, radius in metres
            nearest: x, y, count
            min
            max
            crs: of coordinates given and returned; empty: the map's
            sensor: name or file of the profile that weighs the quality; empty: equal weights
            min_confidence
            min_quality
            largest: feature, or other column of numbers, whose largest values come first
            limit"""
        ...
    def landmarks(self, type: Any = ..., *, bbox: Sequence[Any] | _Path = ..., aoi: _Path = ..., near: Sequence[Any] | _Path = ..., nearest: Sequence[Any] | _Path = ..., min: Sequence[Any] | _Path = ..., max: Sequence[Any] | _Path = ..., crs: _Path = ..., sensor: _Path = ..., min_confidence: float = ..., min_quality: float = ..., largest: _Path = ..., limit: int = ..., **conditions: Any) -> np.ndarray:
        """Returns the landmarks of one type as a structured array with the columns of `waymark query`.

        type may be left out if the map has landmarks of one type only. Unknown numbers are NaN.
        min_FEATURE and max_FEATURE bound any number of the landmarks: min_prominence=300.

        Keywords:
            bbox: min_x, min_y, max_x, max_y
            aoi: file of polygons in any CRS of the body; empty: everywhere
            near: x, y, radius in metres
            nearest: x, y, count
            min
            max
            crs: of coordinates given and returned; empty: the map's
            sensor: name or file of the profile that weighs the quality; empty: equal weights
            min_confidence
            min_quality
            largest: feature, or other column of numbers, whose largest values come first
            limit"""
        ...
    def to_geopandas(self, type: Any = ..., *, bbox: Sequence[Any] | _Path = ..., aoi: _Path = ..., near: Sequence[Any] | _Path = ..., nearest: Sequence[Any] | _Path = ..., min: Sequence[Any] | _Path = ..., max: Sequence[Any] | _Path = ..., crs: _Path = ..., sensor: _Path = ..., min_confidence: float = ..., min_quality: float = ..., largest: _Path = ..., limit: int = ..., **conditions: Any) -> Any:
        """Returns the landmarks of one type as a GeoDataFrame of points, indexed by uid.

        Keywords:
            bbox: min_x, min_y, max_x, max_y
            aoi: file of polygons in any CRS of the body; empty: everywhere
            near: x, y, radius in metres
            nearest: x, y, count
            min
            max
            crs: of coordinates given and returned; empty: the map's
            sensor: name or file of the profile that weighs the quality; empty: equal weights
            min_confidence
            min_quality
            largest: feature, or other column of numbers, whose largest values come first
            limit"""
        ...

class OutputError(Error):
    """A result that cannot be written; exit code 1."""

class Run:
    """What a job did: landmarks written by type, the report of each stage, and the map if one was written."""
    landmarks: dict
    report: dict
    map: Map

class UnitsFailed(Error):
    """The run finished, but some units failed; exit code 3. `result` is what was made."""
    result: Any

class Warning(UserWarning):
    """A warning of a workflow."""

def detect(kind: Any, image: Any, *, progress: Any = ..., output: _Path = ..., method: _Path = ..., crs: _Path = ..., sun_azimuth: float = ..., sun_elevation: float = ..., image_sun_angle: float = ..., gsd: float = ..., min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ..., aoi: _Path = ..., band: int = ..., tile_pixels: int = ..., threads: int = ..., verifier: _Path = ...) -> np.ndarray:
    """Returns the objects of one kind, a name of `image_detectors()`, in an image as a structured array.

    image is a file or an array: (rows, columns) or (rows, columns, bands). The columns are those of
    docs/reference/detection_table.md: pixels, and metres where the pixel size is known. The options are those of
    `waymark detect`, with underscores.

    Keywords:
        output: .csv, .geojson, .json or .gpkg; empty: no file is written
        method: of the detector; empty: its first one, or chosen by the image (craters: bowl, edges; rocks: shadow, classic; trees: imagery, peaks, lmf)
        crs: of a georeferenced image that names none or a wrong one
        sun_azimuth: degrees clockwise from map north
        sun_elevation: degrees above the horizon
        image_sun_angle: degrees from x towards y, to the sun
        gsd: metres per pixel
        min_diameter: pixels
        max_diameter: pixels
        min_confidence: 0 to 1
        aoi: polygons: detections outside are dropped; georeferenced images only; empty: none
        band: from 1; 0: brightness of a colour image, else the first
        tile_pixels: side of the pieces of a large image, pixels
        threads: 0: one per processor
        verifier: craters: verifier that `waymark train craters --labels` wrote, instead of the shipped one"""
    ...

def evaluate(result: Any, truth: Any, *, progress: Any = ..., ignore: _Path = ..., type: _Path = ..., sensor: _Path = ..., by: _Path = ..., tolerance: float = ..., min_tolerance: float = ..., min_diameter: float = ..., min_pixels: float = ..., size_edges: Sequence[Any] | _Path = ...) -> dict[str, Any]:
    """Compares a map or table of landmarks with the truth, as `waymark evaluate landmarks --format json`.

    Returns scores by type. options: ignore, type, by, tolerance, min_diameter, ...

    Keywords:
        ignore: true objects that count neither way; empty: none
        type: compare one landmark type; empty: all that the truth has
        sensor: profile that weighs the quality of a map; empty: equal weights
        by: "distance" or "overlap"
        tolerance: of a pair, in diameters
        min_tolerance: of a pair, in units of the positions
        min_diameter: smaller true objects are not evaluated
        min_pixels: true objects smaller than this in every image are not evaluated
        size_edges: ascending diameters between which results are reported apart"""
    ...

def evaluate_track(track: Any, truth: Any, *, drive: Any = ..., align: _Path = ..., log_format: _Path = ..., columns: _Path = ..., robot: int = ..., max_gap: float = ..., picture: _Path = ..., map: _Path = ..., also: Sequence[Any] | _Path = ...) -> dict[str, Any]:
    """Compares a track file with a log or track that has the truth, as `waymark evaluate track --format json`.

    drive: more pairs (track, truth), whose summary is then returned. also: more tracks of the picture, NAME=TRACK.

    Keywords:
        align: "none", "se2" or "sim2"
        log_format: waymark, csv, mrclam, victoria-park, carmen, rosbag2, mcap, points, isam, g2o, toro; empty: recognised by what is there
        columns: csv: target=expression, separated by commas (import_csv_log)
        robot: MRCLAM: which of the five; 0: the robot of the named file
        max_gap: s between two true poses that may be interpolated
        picture: .svg to draw; empty: none
        map: map that is drawn and whose frame the truth is put in
        also: NAME=TRACK.csv: more tracks of the picture"""
    ...

def find_buildings(las: Any = ..., *, dsm: Any = ..., dtm: Any = ..., chm: Any = ..., poles: Any = ..., trees: Any = ..., output: Any = ..., transform: Any = ..., crs: Any = ..., cell: Any = ..., progress: Any = ..., **options: Any) -> Any:
    """Returns the buildings of a town, as `waymark buildings`; walls, corners, poles and outlines are in its map.

    las is a file of laser points, a folder or a list, with or without dtm; or else give dsm and dtm, or chm. Without
    `poles` none are searched; with `trees` those that are not on roofs are mapped, too. Other arguments as for
    `find_mountain_tops`. Options: min_area, max_extent, roughness, overhang, ..."""
    ...

def find_craters(image: Any, *, progress: Any = ..., output: _Path = ..., method: _Path = ..., crs: _Path = ..., sun_azimuth: float = ..., sun_elevation: float = ..., image_sun_angle: float = ..., gsd: float = ..., min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ..., aoi: _Path = ..., band: int = ..., tile_pixels: int = ..., threads: int = ..., verifier: _Path = ...) -> np.ndarray:
    """Returns the craters of an image: see `detect`.

    Keywords:
        output: .csv, .geojson, .json or .gpkg; empty: no file is written
        method: of the detector; empty: its first one, or chosen by the image (craters: bowl, edges; rocks: shadow, classic; trees: imagery, peaks, lmf)
        crs: of a georeferenced image that names none or a wrong one
        sun_azimuth: degrees clockwise from map north
        sun_elevation: degrees above the horizon
        image_sun_angle: degrees from x towards y, to the sun
        gsd: metres per pixel
        min_diameter: pixels
        max_diameter: pixels
        min_confidence: 0 to 1
        aoi: polygons: detections outside are dropped; georeferenced images only; empty: none
        band: from 1; 0: brightness of a colour image, else the first
        tile_pixels: side of the pieces of a large image, pixels
        threads: 0: one per processor
        verifier: craters: verifier that `waymark train craters --labels` wrote, instead of the shipped one"""
    ...

def find_craters_in_dem(dem: Any, *, output: Any = ..., transform: Any = ..., crs: Any = ..., cell: Any = ..., progress: Any = ..., **options: Any) -> Any:
    """Returns the craters of a DEM, as `waymark craters`; arguments as for `find_mountain_tops`."""
    ...

def find_mountain_tops(dem: Any, *, output: Any = ..., transform: Any = ..., crs: Any = ..., cell: Any = ..., progress: Any = ..., **options: Any) -> Any:
    """Returns the mountain tops of a DEM with exact prominence and isolation, as `waymark peaks`.

    dem is an array, a file or a list of them. An array takes `transform` and `crs` as rasterio has them; without a
    CRS it is in metres, with square cells of the side `cell`. With `output` the map is written and returned as a Map,
    else the landmarks as a structured array. Options: min_prominence, min_isolation, nodata, base, ..."""
    ...

def find_rocks(image: Any, *, progress: Any = ..., output: _Path = ..., method: _Path = ..., crs: _Path = ..., sun_azimuth: float = ..., sun_elevation: float = ..., image_sun_angle: float = ..., gsd: float = ..., min_diameter: float = ..., max_diameter: float = ..., min_confidence: float = ..., aoi: _Path = ..., band: int = ..., tile_pixels: int = ..., threads: int = ..., verifier: _Path = ...) -> np.ndarray:
    """Returns the rocks of an image: see `detect`. Heights need gsd and sun_elevation.

    Keywords:
        output: .csv, .geojson, .json or .gpkg; empty: no file is written
        method: of the detector; empty: its first one, or chosen by the image (craters: bowl, edges; rocks: shadow, classic; trees: imagery, peaks, lmf)
        crs: of a georeferenced image that names none or a wrong one
        sun_azimuth: degrees clockwise from map north
        sun_elevation: degrees above the horizon
        image_sun_angle: degrees from x towards y, to the sun
        gsd: metres per pixel
        min_diameter: pixels
        max_diameter: pixels
        min_confidence: 0 to 1
        aoi: polygons: detections outside are dropped; georeferenced images only; empty: none
        band: from 1; 0: brightness of a colour image, else the first
        tile_pixels: side of the pieces of a large image, pixels
        threads: 0: one per processor
        verifier: craters: verifier that `waymark train craters --labels` wrote, instead of the shipped one"""
    ...

def find_trees(chm: Any = ..., *, dsm: Any = ..., dtm: Any = ..., las: Any = ..., flights: Any = ..., crowns: Any = ..., output: Any = ..., transform: Any = ..., crs: Any = ..., cell: Any = ..., progress: Any = ..., **options: Any) -> Any:
    """Returns the trees of a canopy, as `waymark trees`.

    chm is a canopy height model (array, file or list), or else give dsm and dtm, or las with or without dtm. Other
    arguments as for `find_mountain_tops`. Options: preset, min_height, allometry, species, ..."""
    ...

def hazards(map: Any, output: Any, *, progress: Any = ..., dem: Sequence[Any] | _Path = ..., vehicle: _Path = ..., polygons: _Path = ..., nav2: _Path = ..., height_sd: float = ..., height_correlation: float = ..., rock_cover: float = ..., detection_limit: float = ..., uncertain: float = ..., hazard: float = ..., landing_ellipse: _Path = ..., sun: _Path = ..., horizon_reach: float = ..., aoi: _Path = ..., crs: _Path = ..., tile_cells: int = ..., threads: int = ...) -> dict[str, Any]:
    """Writes a hazard map of a map or a DEM, as `waymark hazards`; returns the numbers of its `--format json`: cells by
    class, objects, rock_cover, ... options: vehicle, dem, polygons, nav2, ...

    Keywords:
        dem: DEM of a map; empty: stored in the map
        vehicle
        polygons: GeoPackage for the layer `hazard`; empty: none
        nav2: map.yaml; empty: none
        height_sd: metres; NaN: that of the DEM
        height_correlation: metres
        rock_cover: k of the site; NaN: fitted to its rocks
        detection_limit: metres; NaN: fitted to its rocks
        uncertain
        hazard
        landing_ellipse: MAJOR,MINOR[,AZIMUTH] for the band `landing`; empty: none
        sun: AZIMUTH,ELEVATION in degrees for the bands `horizon`, `shade`; empty: none
        horizon_reach: metres
        aoi: polygons: terrain outside is unknown; empty: all
        crs: of a DEM whose file has none
        tile_cells
        threads"""
    ...

def image_detectors() -> dict[str, dict[str, Any]]:
    """Returns the detectors of `detect` by name: {"rocks": {"summary": ..., "type": ..., "methods": ...}, ...}.

    methods has the record that each reads, "image" or "heights"; settings the description of each of its own."""
    ...

def inventory(map: Any, stands: Any = ..., *, output: Any = ..., progress: Any = ..., stands_layer: _Path = ..., aoi: _Path = ..., grid: float = ..., allometry: _Path = ..., volume: _Path = ..., recall: _Path = ..., max_trees: int = ..., class_width: float = ..., report: _Path = ...) -> list[dict[str, Any]]:
    """Counts the trees of a map by stand, as `waymark inventory`; returns a list with a dict for each stand.

    stands is a layer of polygons in any CRS; without it and without `grid` the whole map is one stand. The keys are
    the columns of docs/reference/inventory_table.md, so pandas.DataFrame(waymark.inventory(map)) is the table. An
    unknown number is None. Raises UnitsFailed if some stands have no area; its `result` has the others.

    Keywords:
        stands_layer: of a file that holds several
        aoi: polygons, each a stand, in place of `stands`; trees outside do not count
        grid: metres, side of square cells in place of stands; 0: none
        allometry: table of stem diameters by species; empty: those of the map
        volume: table of form factors by species; empty: 0.47 +- 0.04 for all
        recall: table of detection rates by height; empty: all trees were detected
        max_trees: trees held in memory, 1 kB each; figures do not depend on it
        class_width: centimetres, of diameter classes
        report: .html to write; empty: none"""
    ...

def load_plug_in(file: Any) -> None:
    """Loads a shared library with landmark types, stages and detectors, as `waymark --plugin FILE.so` does.

    Load it before anything else: no other thread may use the package meanwhile. It stays loaded."""
    ...

def localize(map: Any, log: Any, *, method: Any = ..., settings: _Settings = ..., start: Any = ..., progress: Any = ..., output: _Path = ..., sensor: _Path = ..., min_confidence: float = ..., seed: int = ..., log_format: _Path = ..., columns: _Path = ..., topic: Sequence[Any] | _Path = ..., robot: int = ..., use_identities: bool = ..., write_map: _Path = ..., update_map: bool = ..., dem: Sequence[Any] | _Path = ..., in_map_crs: bool = ..., layers: _Path = ..., timing: bool = ..., live: float = ..., threads: int = ...) -> Localization:
    """Follows a robot through a map by its log, as `waymark localize`; returns a Localization.

    map is a Map or a file ("none": without a map). start is (x, y, yaw) in metres and radians, "truth" or "none".
    settings: {"option": value} of the method, see `localize_settings`. options: output, sensor, seed,
    use_identities, log_format, dem, write_map, ...

    Keywords:
        output: track: .csv, .gpkg, .tum, .kitti, .g2o; empty: none
        sensor: profile of eq. 8, for `quality=paper` and maps without confidence; empty: equal weights
        min_confidence: landmarks less probable than this are not used
        seed: of all random numbers
        log_format: waymark, csv, mrclam, victoria-park, carmen, rosbag2, mcap, points, isam, g2o, toro; empty: recognised by what is there
        columns: csv: target=expression, separated by commas (import_csv_log)
        topic: rosbag2, mcap: read these where a bag has several of a type
        robot: MRCLAM: which of the five; 0: the robot of the named file
        use_identities: identities in the log are used for data association
        write_map: slam, graph: map to write with the updates; empty: none
        update_map: slam, graph: change the map itself
        dem: terrain under the map; empty: the map's own coverage if it has one
        in_map_crs: a .csv has positions in the map's CRS, not in the map frame
        layers: map that gets the layers track and harvested; empty: none
        timing: a .csv has the duration of each update
        live: s of the log between two writings of `layers`; 0: at the end only
        threads: 0: one per processor"""
    ...

def localize_methods() -> list[str]:
    """Returns the names of the methods."""
    ...

def localize_settings(method: Any = ...) -> dict[str, tuple[str, str]]:
    """Returns {setting: (value, effect)} of a method."""
    ...

def map_images(images: Any, output: Any, *, find: Any = ..., progress: Any = ..., cameras: _Path = ..., dem: Sequence[Any] | _Path = ..., crs: _Path = ..., height_sd: float = ..., **options: Any) -> Run:
    """Maps the rocks and craters that images show, as `waymark images`; returns a Run.

    images: files, patterns or folders. Options of the stage load_images: camera_format, sun_azimuth, gsd, ...

    Keywords:
        cameras: camera file or pattern; empty: the images are orthophotos
        dem: empty: level ground at height 0
        crs: of the DEM instead of its own, or of level ground
        height_sd: metres, of a height of the ground; 0: not known"""
    ...

def merge(maps: Any, output: Any, *, progress: Any = ..., aoi: _Path = ..., changes: bool = ..., max_move: float = ...) -> dict[str, int]:
    """Merges maps of one CRS into one, as `waymark merge`; returns counts: landmarks, fused, identical.

    options: aoi, changes, max_move. With changes also gone, new, moved, unchanged and not_covered, from the first map
    to the second.

    Keywords:
        aoi: polygons: landmarks outside are left out of the result; empty: none are
        changes: find what changed from the first to the second map, two only
        max_move: m; what moved farther is gone and new"""
    ...

def open(path: Any) -> Map:
    """Opens a map file. Raises waymark.Error if it is missing, damaged or of a newer version."""
    ...

def read_map(path: Any) -> Map:
    """Opens a map file. Raises waymark.Error if it is missing, damaged or of a newer version."""
    ...

def reconstruct(images: Any, folder: Any, *, until: Any = ..., progress: Any = ..., cameras: _Path = ..., camera_crs: _Path = ..., lens: _Path = ..., readout_time: float = ..., control: _Path = ..., marks: _Path = ..., altimeter: _Path = ..., map_image: _Path = ..., dem: _Path = ..., crs: _Path = ..., cell: float = ..., aoi: _Path = ..., map: _Path = ..., work: _Path = ..., threads: int = ...) -> dict[str, int]:
    """Makes cameras, a DEM and an orthophoto of images in a folder, as `waymark reconstruct`; returns counts.

    until: "poses", "dem" or "ortho". options: cameras, lens, control, marks, dem, crs, cell, map, threads.
    Raises UnitsFailed if some images have no pose or some units of the map failed; what could be made is there.

    Keywords:
        cameras: camera file with the poses, which names the images if none are given; empty: they are solved; `control` then ties them to the map
        camera_crs: CRS of the positions, if the file names none
        lens: camera file whose lens is kept fixed; empty: self-calibration
        readout_time: s from the first row to the last, where `lens` states none
        control: surveyed points; empty: none
        marks: table of their marks; empty: `control` is a gcp_list.txt
        altimeter: table of heights of images; empty: none
        map_image: orthophoto of the site, the reference if there is no better; empty: none
        dem: coarse DEM, start of heights, and the reference if there is no other; empty: none
        crs: of the map; empty: that of camera file or references, else a UTM zone
        cell: of the DEM, metres; 0: twice the median ground sample distance
        aoi: polygons: DEM and orthophoto cover the box around them; empty: all
        map: GeoPackage of landmarks; empty: none
        work: folder that keeps the results of steps for later runs; empty: none
        threads: 0: one per processor"""
    ...

def route(map: Any, start: Any, goal: Any, output: Any, *, sensor: Any, via: Any = ..., progress: Any = ..., hazards: _Path = ..., aoi: _Path = ..., range: float = ..., view: float = ..., limit_sigma: float = ..., keep_landmarks: float = ..., weight: float = ..., by_quality: bool = ..., cell: float = ..., start_sd: float = ..., least_sigma: bool = ..., odometry: _Path = ..., speed: float = ..., sensor_height: float = ..., identities_known: bool = ..., worlds: int = ..., alternatives: int = ..., seed: int = ..., dem: Sequence[Any] | _Path = ..., vehicle: _Path = ...) -> dict[str, Any]:
    """Plans a route and writes it to `output`, as `waymark route`.

    start is (x, y) or (x, y, yaw in degrees), goal and each via (x, y), in the map's CRS. One of limit_sigma,
    keep_landmarks and weight says what is wanted. Returns {"routes": [...], "shortest": ..., "lower_bound": ...};
    each route has its length, standard deviations and `stations` as a structured array.

    Keywords:
        hazards: hazard map (.tif), or none
        aoi: polygons: the route stays inside; empty: anywhere
        range
        view
        limit_sigma: metres; 0: none
        keep_landmarks: number; 0: not wanted
        weight: metres of detour per metre at an sd of 1 m
        by_quality: keep_landmarks sums qualities
        cell: metres
        start_sd: metres; 0: that of the odometry's log, else 0.1
        least_sigma: the smallest worst sd
        odometry: log of the vehicle, whose odometry noise is used; empty: the defaults
        speed: m/s, turns biases of rates into errors per metre
        sensor_height: metres above the terrain
        identities_known: false: sightings can be taken for other landmarks
        worlds: random sets of existing landmarks
        alternatives
        seed
        dem: terrain that hides landmarks, for clearance and tilt at the stations; empty: that stored in the map hides, no clearance
        vehicle: of clearance and tilt"""
    ...

def run(job: Any, output: Any = ..., *, settings: Any = ..., folder: Any = ..., progress: Any = ..., work: _Path = ..., stage: _Path = ..., rerun_from: _Path = ..., unit: _Path = ..., check: bool = ..., with_dem: bool = ..., sensor: _Path = ..., threads: int = ...) -> Run:
    """Runs a job and returns a Run; `output` is the map to write.

    job is a job file or a dict {"name": ..., "stages": [...]}, made by hand or with waymark.stages. Relative paths of
    a dict start at `folder` (default: the current one). settings: {"stage.option": value}. options: work, stage,
    threads, rerun_from, check, with_dem, sensor. progress(stage, done, total, rate) is called now and then.
    Raises UnitsFailed if some units failed.

    Keywords:
        work: folder of finished work; empty: everything in memory
        stage: single stage to run, or its part in `shard`; needs `work`
        rerun_from: stage to re-run with its dependents; empty: finished work is kept
        unit: single unit of work to run; needs `work`
        check: check options, wiring and files only
        with_dem: store the DEM in the map
        sensor: profile recorded in the map; empty: none
        threads: 0: one per processor"""
    ...

def simulate(scenario: Any, folder: Any, *, progress: Any = ..., seed: int | None = ..., drive_seed: int | None = ..., drive_only: bool = ...) -> dict[str, int]:
    """Makes a site with its truth in a folder, as `waymark simulate`; returns counts. options: seed, drive_seed,
    drive_only.

    Keywords:
        seed: in place of the scenario's
        drive_seed: in place of that of the section drive
        drive_only: write the drive and its truth, no DEM and no images"""
    ...

def web(map: Any, output: Any, *, progress: Any = ..., aoi: _Path = ..., types: Sequence[Any] | _Path = ..., min_confidence: float = ..., dem: Sequence[Any] | _Path = ..., terrain_pixels: int = ..., max_zoom: int = ..., assets: _Path = ..., title: _Path = ..., threads: int = ...) -> dict[str, int]:
    """Writes a folder that shows a map in web browsers, as `waymark web`; returns the numbers of its `--format json`:
    landmarks, outside, max_zoom, landmark_tiles, terrain_tiles, areas, area_tiles, has_library.

    Keywords:
        aoi: polygons: landmarks outside are left out; empty: none are
        types: landmark types shown; empty: all
        min_confidence: landmarks of less are left out
        dem: elevation models; empty: stored in the map, or read by its runs
        terrain_pixels: of the longer side of the terrain, at most; 0: no terrain
        max_zoom: zoom that shows all landmarks; -1: chosen by their density
        assets: folder of the map library; empty: fetched later
        title: empty: the map's name
        threads"""
    ...
