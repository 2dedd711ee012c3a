// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage_pages.hpp"

#include <nlohmann/json.hpp>

#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const TypedStep<toy::SquareNumber> kSquareStep;
const TypedStep<toy::ListNumbers> kList;

TEST(StagePages, Markdown) {
  EXPECT_EQ(stage_as_markdown(kSquareStep), R"(# square_number

Raises the number of a tile to a power

| | |
|---|---|
| version | 2 |
| works on | one tile and 3 cells around it |
| reads | number (Number) |
| writes | square (Number) |

| option | effect | values | default |
|---|---|---|---|
| `power` | Exponent | [0.5, 4] | 2 |
| `keep` | Which squares are kept | all, even, none | all |
| `height` | A length \| unused | at least 0 m | 20 m |
| `loud` | Warn in every tile | true or false | false |
| `memory` | Bytes it may take (does not change the result) | at least 1 | 1 |

In a job file:

```json
{"stage": "square_number", "power": 2.0, "keep": "all", "height": 20.0, "loud": false, "memory": 1}
```
)");
}

TEST(StagePages, Text) {
  EXPECT_EQ(stage_as_text(kList), R"(list_numbers: Lists tiles and writes a number

  works on  the whole map; runs while planning and decides the tiles
  reads     none
  writes    tiles (vector<Tile>), number (Number)

Options:
  tiles                How many tiles there are
                       [0, 100000]; default: 4
  files                Files that count as read
                       list of texts; default: none
)");
}

TEST(StagePages, Schema) {
  const auto schema = nlohmann::json::parse(stage_as_schema(kSquareStep));
  EXPECT_EQ(schema["properties"]["stage"], (nlohmann::json{{"const", "square_number"}}));
  EXPECT_EQ(schema["properties"]["height"], (nlohmann::json{{"type", "number"},
                                                            {"description", "A length | unused"},
                                                            {"default", 20.0},
                                                            {"x-unit", "m"},
                                                            {"minimum", 0.0}}));
  EXPECT_EQ(schema["properties"]["keep"]["enum"], (nlohmann::json{"all", "even", "none"}));
  EXPECT_EQ(schema["properties"]["memory"]["x-affects-result"], false);
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], nlohmann::json::array({"stage"}));
  const auto list = nlohmann::json::parse(stage_as_schema(kList));
  EXPECT_EQ(list["properties"]["files"]["items"], (nlohmann::json{{"type", "string"}}));
}

TEST(StagePages, Json) {
  const auto json = nlohmann::json::parse(stage_as_json(kList));
  EXPECT_EQ(json["name"], "list_numbers");
  EXPECT_EQ(json["scope"], "map");
  EXPECT_EQ(json["lists"], "tile");
  EXPECT_EQ(json["outputs"][0], (nlohmann::json{{"name", "tiles"}, {"type", "vector<Tile>"}}));
  EXPECT_EQ(json["options"]["tiles"]["default"], 4);
}

}  // namespace
}  // namespace waymark::test
