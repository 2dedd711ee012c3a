// SPDX-License-Identifier: Apache-2.0
#include "landmarks/landmark_type.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace waymark::test {
namespace {

using testing::HasSubstr;

std::string refusal(LandmarkType type) {
  TypeRegistry types;
  try {
    types.add(std::move(type));
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return {};
}

LandmarkType post() {
  return {.name = "post",
          .summary = "",
          .features = {{"width", "m", Scale::ratio, 0, 1e9, ""}},
          .body = {"width", 0.5}};
}

TEST(LandmarkType, BodyAndReachMustBeUsable) {
  EXPECT_EQ(refusal(post()), "");
  LandmarkType type = post();
  type.body.feature = "radius";
  EXPECT_THAT(refusal(type), HasSubstr("measured by 'radius'"));
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    type = post();
    type.body.radius_per_value = wrong;
    EXPECT_THAT(refusal(type), HasSubstr("must be above 0"));
    type = post();
    type.identification_reach = wrong;
    EXPECT_THAT(refusal(type), HasSubstr("must be above 0"));
  }
}

TEST(LandmarkType, EvidenceModelsHaveNames) {
  for (const EvidenceModel model : {EvidenceModel::none, EvidenceModel::shadow_caster, EvidenceModel::bowl,
                                    EvidenceModel::canopy, EvidenceModel::upright})
    EXPECT_EQ(parse_evidence_model(to_string(model)), model);
  EXPECT_EQ(to_string(EvidenceModel::shadow_caster), "shadow_caster");
  EXPECT_THROW(parse_evidence_model("cylinder"), std::logic_error);
}

TEST(LandmarkType, IsFoundByWhatItDeclares) {
  TypeRegistry types;
  EXPECT_FALSE(find_type(types, EvidenceModel::upright));
  types.add(post());
  LandmarkType tag = post();
  tag.name = "tag", tag.evidence = EvidenceModel::upright, tag.identifies_itself = true;
  types.add(tag);
  EXPECT_EQ(find_type(types, EvidenceModel::upright), TypeId{1});
  EXPECT_EQ(find_self_identifying_type(types), TypeId{1});
}

}  // namespace
}  // namespace waymark::test
