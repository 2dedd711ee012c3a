// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/records/make_stac.hpp"

namespace waymark::apps {
namespace {

class Stac final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "stac",
        .group = Group::use,
        .summary = "Describe maps and rasters in a STAC catalogue",
        .about =
            "An item says where and when a file is valid, in longitude and latitude on its body, how it was "
            "made, and its checksum. One file may go to one item; a folder gets collection.json and an item "
            "for each file, named after it.",
        .arguments = {file_word("FILE...", &request_.files, "Maps and rasters"),
                      Argument{"-o,--output", "ITEM.json|DIR", &request_.output, "Item or folder to write"}
                          .needed()
                          .offering(Offer::file),
                      Argument{"--collection", "ID", &request_.collection, "Name of the collection"}.or_else(
                          "that of the folder"),
                      {"--description", "TEXT", &request_.description, "What the item or the collection is"},
                      Argument{"--datetime", "UTC", &request_.datetime,
                               "Time of the data of files that state none"}
                          .or_else("when they were made"),
                      Argument{"--href", "URL", &request_.href,
                               "Address of the folder that will serve the files"}
                          .or_else("paths relative to the records"),
                      format_option(&format_)},
        .examples = {{"waymark stac alps.gpkg -o alps.json", "An item"},
                     {"waymark stac site.gpkg dem.tif hazard.tif -o catalogue --collection landing_site",
                      "A collection of three items"},
                     {"waymark stac maps/*.gpkg -o catalogue --href https://example.org/maps",
                      "Files that a server will hold"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    const workflows::StacResult made = workflows::make_stac(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(),
                   {{"items", made.items}, {"collection", text_or_null(made.collection)}, {"id", made.id}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"items", ResultKind::texts, "Items that were written, in the order of the files"},
            {"collection", ResultKind::text, "collection.json; null for a single item"},
            {"id", ResultKind::text, "Id of the collection, or of the single item"}};
  }

  std::string format_ = "text";
  workflows::StacRequest request_;
};

}  // namespace

void register_command_stac(CommandTable& commands);
void register_command_stac(CommandTable& commands) {
  commands.add<Stac>();
}

}  // namespace waymark::apps
