# Compiles the sources of a library together, so that their headers are parsed once: a clean build takes half
# the time. The presets for development leave it off, since an edited file would rebuild its whole unit.
option(WAYMARK_UNITY "Compile several sources of a library at a time" OFF)
# Files whose private names occur in other files of their library, too, and decompositions of Eigen: the time of g++
# grows with the square of their number in a unit. And small files about versions, so that a new one moves no other.
set(alone
  apps/commands/man.cpp apps/result.cpp apps/version.cpp apps/waymark.cpp
  core/solve/cholesky.cpp core/solve/inverse_by_lu.cpp core/solve/least_squares.cpp core/solve/rotations.cpp
  core/solve/singular_values.cpp core/solve/solve_symmetric.cpp core/solve/symmetric_eigen.cpp
  geo/proj_version.cpp geo/terrain_pyramid.cpp
  exporters/report/histogram.cpp exporters/report/landmark_table.cpp exporters/report/log_plot.cpp exporters/report/track_picture.cpp exporters/vector/ogr_output.cpp exporters/web/web_shapes.cpp
  geodb/library_versions.cpp geodb/geopackage/geometry_blob.cpp geodb/geopackage/shape_blob.cpp
  importers/cameras/formats/opk.cpp importers/logs/bag_cloud.cpp importers/logs/bag_messages.cpp importers/logs/binary_number.cpp importers/logs/gyro_yaw.cpp importers/logs/log_line.cpp importers/logs/waymark_log.cpp importers/cameras/world_to_grid.cpp importers/images/find_images.cpp importers/images/sun_position.cpp
  importers/points/canopy_codec.cpp importers/points/inspect_canopy.cpp importers/rasters/mosaic.cpp importers/stages/load_dem.cpp
  importers/rules/import_rules.cpp importers/rules/ogr_elements.cpp importers/rules/bound_rule.cpp importers/rules/cityjson_elements.cpp importers/logs/point_files.cpp importers/logs/robot_readings.cpp importers/tables/stand_outlines.cpp importers/tables/table_ogr.cpp importers/tables/table_number.cpp
  localization/ceres_version.cpp localization/detectors/cloud_facades.cpp localization/filters/sighting_score.cpp localization/filters/particle_blocks.cpp
  localization/global/skyline.cpp localization/global/skyline_fit.cpp localization/identification/identification.cpp
  localization/slam/pose_graph_builder.cpp
  pipeline/craters/crater_training.cpp pipeline/craters/dem_rim.cpp pipeline/craters/find_craters_in_dem.cpp
  pipeline/craters/shaded_scene.cpp pipeline/craters/tile_correlation.cpp pipeline/craters/tile_spectrum.cpp
  pipeline/engine/job.cpp pipeline/engine/report.cpp pipeline/engine/store/artifact_store.cpp
  pipeline/forest/canopy_model.cpp pipeline/fusion/cleaning/rim_shadows.cpp pipeline/fusion/projection/crest_correction.cpp pipeline/fusion/projection/image_view_codec.cpp
  pipeline/fusion/valuation/landmark_valuation.cpp pipeline/vision/opencv_version.cpp
  tests/apps/commands/buildings_test.cpp tests/geo/outline_shapes_test.cpp
  testbed/landing/crater_field.cpp testbed/landing/crater_profile.cpp
  testbed/landing/make_rock.cpp testbed/landing/rock_field.cpp testbed/score_match.cpp
  tests/apps/commands/area_of_interest_test.cpp tests/exporters/vector/track_file_test.cpp tests/workflows/planning/sight_terrain_test.cpp
  workflows/build_details.cpp workflows/plug_in_build.cpp)

function(waymark_unity TARGET)
  set(sources_per_unit 24)
  # The time of g++ grows faster than the number of instantiations of Eigen, and a test target has work for every core.
  if("${TARGET}" MATCHES "_(reconstruction|localization|pipeline|tests)$")
    set(sources_per_unit 6)
  endif()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ${WAYMARK_UNITY} UNITY_BUILD_BATCH_SIZE ${sources_per_unit})
  list(TRANSFORM alone PREPEND ${PROJECT_SOURCE_DIR}/)
  set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
