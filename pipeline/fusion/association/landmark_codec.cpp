// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/landmark_codec.hpp"

#include "core/bytes.hpp"
#include "pipeline/fusion/association/observation_bytes.hpp"

namespace waymark::pipeline {
namespace {

// Each layout is defined once for both directions: `io` is a ByteWriter or a ByteReader.
void layout(auto& io, auto& matrix) requires requires {
  matrix.reshaped();
}
{
  for (auto& v : matrix.reshaped()) io(v);
}
void layout(auto& io, auto& outline) requires requires {
  outline.major;
}
{ io(outline.x), io(outline.y), io(outline.major), io(outline.minor), io(outline.angle); }

void write(ByteWriter& out, const Detection& d) {
  out(d.type);
  layout(out, d.outline);
  layout(out, d.covariance);
  out(d.diameter_sd);
  out(d.shadow_reach.has_value());
  if (d.shadow_reach)
    out(d.shadow_reach->value), out(d.shadow_reach->sd), out(d.reach_slope_response),
        out(d.diameter_slope_response);
  out(d.confidence);
}

Detection read_detection(ByteReader& in) {
  Detection d;
  in(d.type);
  layout(in, d.outline);
  layout(in, d.covariance);
  in(d.diameter_sd);
  if (in.get<bool>()) {
    d.shadow_reach.emplace();
    in(d.shadow_reach->value), in(d.shadow_reach->sd), in(d.reach_slope_response),
        in(d.diameter_slope_response);
  }
  in(d.confidence);
  return d;
}

void write(ByteWriter& out, const Observation& o) {
  out(o.type), out(o.landmark_uid), out(o.source);
  out(o.pixel.has_value());
  if (o.pixel) layout(out, *o.pixel);
  layout(out, o.position.xyz);
  layout(out, o.covariance);
  out(o.confidence);
  out(static_cast<std::uint64_t>(o.features.size()));
  for (const FeatureValue& f : o.features) out(f.value), out(f.variance), out(f.observations);
  out(o.rejected);
}

Observation read_observation(ByteReader& in) {
  Observation o;
  in(o.type), in(o.landmark_uid), in(o.source);
  if (in.get<bool>()) layout(in, o.pixel.emplace());
  layout(in, o.position.xyz);
  layout(in, o.covariance);
  in(o.confidence);
  o.features.resize(in.length(20));
  for (FeatureValue& f : o.features) in(f.value), in(f.variance), in(f.observations);
  in(o.rejected);
  return o;
}

std::string encode_all(const auto& items) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(items.size()));
  for (const auto& item : items) write(out, item);
  return out.take();
}

void write(ByteWriter& out, const AttributeValue& value) {
  out(static_cast<std::uint8_t>(value.index()));
  if (const auto* real = std::get_if<double>(&value)) out(*real);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) out(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) out(*text);
}

AttributeValue read_attribute(ByteReader& in) {
  switch (in.get<std::uint8_t>()) {
    case 0:
      return {};
    case 1:
      return in.get<double>();
    case 2:
      return in.get<std::int64_t>();
    case 3: {
      std::string text;
      in(text);
      return text;
    }
    default:
      throw std::runtime_error("unknown kind of attribute in an artifact");
  }
}

void write(ByteWriter& out, const Landmark& l) {
  out(l.uid), out(l.type);
  for (const double v : l.position.xyz) out(v);
  for (const double v : l.covariance.reshaped()) out(v);
  out(static_cast<std::uint64_t>(l.features.size()));
  for (const FeatureValue& f : l.features) out(f.value), out(f.variance), out(f.observations);
  out(static_cast<std::uint64_t>(l.attributes.size()));
  for (const AttributeValue& a : l.attributes) write(out, a);
  out(l.quality.seen), out(l.quality.visible);
  out(static_cast<std::uint64_t>(l.quality.feature_confidences.size()));
  for (const auto& q : l.quality.feature_confidences) out(q.has_value()), out(q.value_or(0));
  out(l.confidence), out(l.observations);
}

Landmark read_landmark(ByteReader& in) {
  Landmark l;
  in(l.uid), in(l.type);
  for (double& v : l.position.xyz) in(v);
  for (double& v : l.covariance.reshaped()) in(v);
  l.features.resize(in.length(20));
  for (FeatureValue& f : l.features) in(f.value), in(f.variance), in(f.observations);
  l.attributes.resize(in.length(1));
  for (AttributeValue& a : l.attributes) a = read_attribute(in);
  in(l.quality.seen), in(l.quality.visible);
  l.quality.feature_confidences.resize(in.length(9));
  for (auto& q : l.quality.feature_confidences) {
    const bool known = in.get<bool>();
    const double value = in.get<double>();
    if (known) q = value;
  }
  in(l.confidence), in(l.observations);
  return l;
}

}  // namespace

std::string Codec<std::vector<Detection>>::encode(const std::vector<Detection>& detections) {
  return encode_all(detections);
}

std::vector<Detection> Codec<std::vector<Detection>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<Detection> detections(in.length(91));
  for (Detection& d : detections) d = read_detection(in);
  in.expect_end();
  return detections;
}

std::string Codec<std::vector<Observation>>::encode(const std::vector<Observation>& observations) {
  return encode_all(observations);
}

std::vector<Observation> Codec<std::vector<Observation>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<Observation> observations(in.length(139));
  for (Observation& o : observations) o = read_observation(in);
  in.expect_end();
  return observations;
}

std::string encode_observation(const Observation& observation) {
  ByteWriter out;
  write(out, observation);
  return out.take();
}

std::vector<Observation> decode_observations(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<Observation> observations;
  while (!in.at_end()) observations.push_back(read_observation(in));
  return observations;
}

std::string Codec<std::vector<Landmark>>::encode(const std::vector<Landmark>& landmarks) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(landmarks.size()));
  for (const Landmark& l : landmarks) write(out, l);
  return out.take();
}

std::vector<Landmark> Codec<std::vector<Landmark>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<Landmark> landmarks(in.length(100));
  for (Landmark& l : landmarks) l = read_landmark(in);
  in.expect_end();
  return landmarks;
}

}  // namespace waymark::pipeline
