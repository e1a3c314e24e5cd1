#include "tools/assess/static_json.h"

#include "mbd/run/ordered_json.h"
#include "mbd/run/result_files.h"

#include <cmath>
#include <numbers>

namespace steplap::assess {

namespace {

OrderedJson number(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr); }

OrderedJson number(const std::optional<double>& value) { return number(value.value_or(NAN)); }

OrderedJson limit_json(const StaticRay& ray, std::size_t i) {
  const StaticLimit& limit = ray.limits[i];
  return {{"kind", name_of(limit.kind)},
          {"element", limit.element},
          {"text", limit_text(ray, i)},
          {"acceleration", number(limit.acceleration)},
          {"error", number(limit.error)}};
}

OrderedJson reaction_json(const StaticReaction& one) {
  const double share = std::abs(one.value) / one.allowed.value_or(NAN);
  return {{"name", one.name}, {"value", number(one.value)}, {"unit", one.unit}, {"allowed", number(one.allowed)}, {"share", number(share)}};
}

OrderedJson criterion_json(const CriterionResult& one) {
  return {{"name", one.name},     {"text", one.text},           {"where", one.where},         {"outcome", steplap::name_of(one.outcome)},
          {"reason", one.reason}, {"value", number(one.value)}, {"limit", number(one.limit)}, {"unit", one.unit}};
}

OrderedJson case_json(const StaticCase& one) {
  OrderedJson json = {{"name", one.load.name},
                      {"ax", one.apparent.x()},
                      {"ay", one.apparent.y()},
                      {"load", {one.load.pull.x(), one.load.pull.y()}},
                      {"verdict", steplap::name_of(one.verdict)},
                      {"why", one.why},
                      {"first", one.first},
                      {"margin", nullptr},
                      {"moved", number(one.moved)},
                      {"slid", one.slid},
                      {"joints", OrderedJson::array()},
                      {"feet", OrderedJson::array()},
                      {"reactions", OrderedJson::array()},
                      {"criteria", OrderedJson::array()},
                      {"tipping", OrderedJson::array()},
                      {"remarks", one.remarks}};
  double least = INFINITY;
  bool is_known = !one.joints.empty();
  for (const StaticJoint& joint : one.joints) {
    json["joints"].push_back({{"name", joint.name}, {"margin", number(joint.margin)}, {"slips", !(joint.margin >= 1.0)}});
    is_known = is_known && !std::isnan(joint.margin);
    least = std::min(least, joint.margin);
  }
  if (is_known) json["margin"] = number(least);
  for (const StaticFoot& foot : one.feet)
    json["feet"].push_back({{"name", foot.name}, {"lifts", foot.lifts}, {"force", number(foot.force)}, {"height", number(foot.height)}});
  for (const StaticReaction& reaction : one.reactions) json["reactions"].push_back(reaction_json(reaction));
  for (const CriterionResult& criterion : one.criteria) json["criteria"].push_back(criterion_json(criterion));
  for (const Tipping& tipping : one.tipping)
    json["tipping"].push_back({{"about", tipping.about},
                               {"lifts", tipping.lifts},
                               {"tilted_by_deg", number(tipping.margin * 180.0 / std::numbers::pi)},
                               {"clockwise", tipping.is_clockwise},
                               {"acceleration", tipping.acceleration > 0.0 ? number(tipping.acceleration) : OrderedJson(nullptr)}});
  return json;
}

OrderedJson direction_json(const StaticDirection& one) {
  OrderedJson json = {{"angle_deg", one.angle * 180.0 / std::numbers::pi},
                      {"first", ""},
                      {"kind", ""},
                      {"element", ""},
                      {"acceleration", nullptr},
                      {"unit", "m/s^2"},
                      {"error", nullptr},
                      {"verdict", "hold"},
                      {"followed_to", number(one.ray.largest)},
                      {"limits", OrderedJson::array()}};
  if (!one.ray.limits.empty()) {
    const StaticLimit& first = one.ray.limits.front();
    json["first"] = limit_text(one.ray, 0);
    json["kind"] = name_of(first.kind);
    json["element"] = first.element;
    json["acceleration"] = number(first.acceleration);
    json["error"] = number(first.error);
    if (!one.is_unique || (first.kind == LimitKind::ends && !one.ray.is_explained)) json["verdict"] = "open";
  }
  for (std::size_t i = 0; i < one.ray.limits.size(); ++i) json["limits"].push_back(limit_json(one.ray, i));
  return json;
}

OrderedJson proof_json(const StaticProof& proof, const std::string& sha256) {
  OrderedJson json = {{"model", proof.model},
                      {"file", proof.file},
                      {"sha256", sha256},
                      {"overrides", proof.overrides},
                      {"plane", name_of(proof.plane)},
                      {"preset", proof.preset.name},
                      {"source", proof.preset.source},
                      {"gravity", {proof.gravity.x(), proof.gravity.y()}},
                      {"verdict", steplap::name_of(proof.verdict)},
                      {"reason", proof.reason},
                      {"largest_acceleration", number(proof.largest)},
                      {"unit", "m/s^2"},
                      {"not_asked", proof.unasked},
                      {"capped_by", proof.caps},
                      {"assumptions", proof.assumptions},
                      {"cases", OrderedJson::array()},
                      {"polar", OrderedJson::array()}};
  json["drawing"] = parse_ordered(proof.drawing);
  for (const StaticCase& one : proof.cases) json["cases"].push_back(case_json(one));
  for (const StaticDirection& one : proof.polar) json["polar"].push_back(direction_json(one));
  return json;
}

} // namespace

std::string static_json(const std::vector<StaticProof>& proofs, const std::vector<std::string>& sha256) {
  OrderedJson json = {{"static_proofs", OrderedJson::array()}};
  for (std::size_t i = 0; i < proofs.size(); ++i) json["static_proofs"].push_back(proof_json(proofs[i], sha256[i]));
  return with_checksum(json.dump(1) + "\n");
}

} // namespace steplap::assess
