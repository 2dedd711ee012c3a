// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/mapping.hpp. The argument is a DEM.
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
using namespace waymark;

namespace {

void make(const std::string& dem) {
  //! [make]
  pipeline::Pipeline pipeline(workflows::all_stages());
  workflows::add_mountain_top_stages(pipeline, {dem});
  pipeline.set("find_mountain_tops.min_prominence=300");
  const workflows::MapResult made =
      workflows::make_map(pipeline::Job{"peaks", std::move(pipeline)}, {.map = "peaks.gpkg"});
  std::cout << made.landmarks.at("mountain_top") << " mountain tops\n" << made.report;
  //! [make]
}

void listen(const std::string& dem) {
  //! [listen]
  pipeline::Pipeline pipeline(workflows::all_stages());
  workflows::add_mountain_top_stages(pipeline, {dem});
  const workflows::Callbacks callbacks{
      .progress =
          [](const pipeline::Progress& now) {
            std::cout << now.stage << ' ' << now.done << '/' << now.total << '\n';
          },
      .message = [](const workflows::Message& message) { std::cout << message.text << '\n'; }};
  workflows::make_map(pipeline::Job{"peaks", std::move(pipeline)}, {.map = "all_peaks.gpkg"}, callbacks);
  //! [listen]
}

void resume(const std::string& dem) {
  //! [resume]
  pipeline::Pipeline pipeline(workflows::all_stages());
  workflows::add_mountain_top_stages(pipeline, {dem});
  const pipeline::RunOptions options{.work = "peaks_work"};  // keeps finished units of work
  const pipeline::Plan units = pipeline::plan(pipeline, options);
  std::cout << units.units.size() << " units\n" << pipeline::plan_as_jsonl(units);
  std::cout << pipeline::run(pipeline, options).report;
  //! [resume]
}

//! [stage]
/// A stage of your own: keeps the landmarks above a height.
struct KeepHighLandmarks {
  struct Options {
    Meters min_height{500};
    void describe(OptionVisitor& option) {
      option("min_height", min_height, {.help = "Lowest landmark kept"});
    }
  };
  static constexpr pipeline::In<std::vector<Landmark>> all{"landmarks"};
  static constexpr pipeline::Out<std::vector<Landmark>> high{"high_landmarks"};
  static pipeline::StageSpec spec() {
    return {
        .name = "keep_high_landmarks", .summary = "Keeps high landmarks", .inputs = {all}, .outputs = {high}};
  }
  static void run(const Options& options, pipeline::StageContext& unit) {
    std::vector<Landmark> kept;
    for (const Landmark& one : unit.read(all)) {
      unit.count_in(1);
      if (one.position.xyz.z() < options.min_height.value)
        unit.reject("too low");
      else
        kept.push_back(one), unit.count_out(1);
    }
    unit.write(high, std::move(kept));
  }
};
//! [stage]

void run_own_stage(const std::string& dem) {
  //! [registry]
  pipeline::Registry stages;
  workflows::register_built_in_stages(stages);
  stages.add<KeepHighLandmarks>();
  pipeline::Pipeline pipeline(stages);
  pipeline.add("load_dem", R"({"files": [")" + dem + R"("]})")
      .add("find_mountain_tops")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops");
  pipeline.add<KeepHighLandmarks>({.min_height = 900_m});
  std::cout << pipeline::run(pipeline).report;
  //! [registry]
}

void read_job_file(const std::string& dem) {
  //! [job]
  const pipeline::Job job =
      pipeline::parse_job(R"({"name": "tops", "stages": [{"stage": "load_dem", "files": [")" + dem + R"("]},
                                {"stage": "find_mountain_tops"}, {"stage": "join_mountain_tops"}]})",
                          workflows::all_stages());
  job.pipeline.check();  // throws Error{usage} if stages do not fit together
  std::cout << pipeline::job_as_json(job.name, job.pipeline) << '\n';
  //! [job]
}

void load_job_file(const std::string& dem) {
  std::ofstream("tops.json") << R"({"name": "tops", "stages": [{"stage": "load_dem", "files": [")"
                             << std::filesystem::absolute(dem).string() << R"("]},
                                {"stage": "find_mountain_tops"}, {"stage": "join_mountain_tops"}]})";
  //! [load]
  const pipeline::Job as_written = pipeline::read_job("tops.json", workflows::all_stages());
  const pipeline::Job job = workflows::load_job("tops.json", {"find_mountain_tops.min_prominence=300"});
  workflows::MapRequest request;
  request.run.threads = 1;
  request.run.work = "tops_work";
  request.run.shard = pipeline::Shard{1, 2};  // this process does the first half of each stage
  std::cout << as_written.name << '\n' << pipeline::run(job.pipeline, workflows::run_options(request)).report;
  //! [load]
  //! [schedule]
  const pipeline::Plan plan = pipeline::plan(job.pipeline, {.work = "tops_work"});
  pipeline::PlanCommand command{.job = "tops.json", .work = "tops_work"};
  command.resources[""] = pipeline::CallResources{.processors = 2, .megabytes = 2000, .minutes = 30};
  std::cout << plan_as_slurm(plan, command) << plan_as_snakemake(plan, command)
            << plan_as_parallel(plan, command);
  std::cout << pipeline::hash_plain_file("tops.json").sha256 << '\n';
  //! [schedule]
}

void choose_stages(const std::string& dem) {
  //! [stages]
  pipeline::Pipeline tops(workflows::all_stages()), craters(workflows::all_stages()),
      trees(workflows::all_stages()), town(workflows::all_stages());
  workflows::add_mountain_top_stages(tops, {dem});
  workflows::add_name_stage(tops, {"gazetteer.gpkg"});  // as `waymark peaks --names gazetteer.gpkg`
  workflows::add_crater_stages(craters, {dem});         // as `waymark craters --dem`
  workflows::add_tree_stages(trees, {.chm = {dem}});    // as `waymark trees --chm`
  const workflows::TownParts parts{.poles = true, .trees = false};
  workflows::add_building_stages(town, {.las = {"tiles"}}, parts);  // as `waymark buildings --las tiles`
  std::cout << pipeline::job_as_json("trees", trees) << '\n';
  //! [stages]
}

void transform() {
  //! [crs]
  const Crs utm = Crs::from_text("EPSG:32633");
  if (utm.kind() != CrsKind::projected) return;
  const CrsTransform to_degrees(utm, geographic_crs(utm));
  const CrsTransform::XY at = to_degrees(500000, 5'500'000);  // easting, northing
  std::cout << at.x << " east, " << at.y << " north\n";
  //! [crs]
}

void measure_prominence() {
  //! [prominence]
  HeightWindow heights(7, 3, kNoHeight);  // one row of cells, and one cell around it
  for (std::int64_t column = 1; column <= 5; ++column)
    heights(column, 1) = std::array{9., 5., 4., 6., 7.}[column - 1];
  GridGeometry grid;
  grid.columns = 5, grid.rows = 1;
  const auto tree = std::make_shared<const pipeline::DivideTree>(
      pipeline::build_divide_tree(heights, {0, 0, 5, 1}, grid, {}));
  for (const pipeline::Summit& summit : pipeline::join_divide_trees({{tree}}, 1, pipeline::BasePolicy::sea))
    std::cout << summit.height << " m, prominence " << summit.prominence << " m\n";  // 9 and 9, 7 and 3
  std::cout << pipeline::prune(*tree, 5).nodes.size() << " summits of more than 5 m\n";
  //! [prominence]
}

void measure_isolation_of_cells() {
  //! [isolation]
  struct Ridge final : DemSource {  // a DEM in memory
    GridGeometry grid{.columns = 5, .rows = 1, .where = {}};
    const GridGeometry& geometry() const override { return grid; }
    NodataPolicy nodata_policy() const override { return NodataPolicy::ocean; }
    HeightWindow read(const Window& window) const override {
      HeightWindow heights(window.columns, window.rows, kNoHeight);
      for (std::int64_t c = 0; c < 5; ++c)
        if (window.contains(c, 0))
          heights(c - window.column, -window.row) = std::array{9., 5., 4., 6., 7.}[c];
      return heights;
    }
    std::vector<std::string> files() const override { return {}; }
  } ridge;
  const Window all{0, 0, 5, 1};
  pipeline::check_distance(pipeline::DistanceKind::planar, ridge.grid);  // throws for degrees
  const auto relief = std::make_shared<const pipeline::BlockRelief>(
      pipeline::block_relief(ridge.read({-1, -1, 7, 3}), all, kNoHeight));
  const std::array summits{pipeline::HighPoint{.cell = 4, .height = 7}};
  const auto isolations = pipeline::measure_isolation(
      summits, ridge, pipeline::ReliefPyramid({{relief}}, 5, 1),
      {.end = pipeline::IsolationEnd::cell, .distance = pipeline::DistanceKind::planar});
  std::cout << isolations[0].metres.value() << " m\n";  // 4, to the cell of height 9
  //! [isolation]
}

}  // namespace

int main(int argc, char** argv) {
  const std::string dem = argc > 1 ? argv[1] : "sample_data/jacksboro/dem.tif";
  for (const auto& step : {make, listen, resume, run_own_stage, read_job_file, load_job_file, choose_stages})
    step(dem);
  transform();
  measure_prominence();
  measure_isolation_of_cells();
}
