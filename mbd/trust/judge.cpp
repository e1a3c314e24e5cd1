#include "mbd/trust/judge.h"

#include "mbd/trust/criteria.h"
#include "mbd/trust/element_judgement.h"
#include "mbd/trust/trust.h"

#include <algorithm>
#include <cstdio>

namespace steplap {

const ChannelRange* find_range(const RunResult& result, const std::string& channel) {
  for (const ChannelRange& range : result.ranges)
    if (range.channel->name == channel) return &range;
  return nullptr;
}

std::string limit_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

Judgement judge(const Model& model, const System& system, const RunResult& result, const std::string& failure) {
  Judgement judgement;
  std::string contradiction; // first contradiction found; later ones have the same cause
  for (const ElementEntry& entry : model.elements) {
    if (!entry.kind->judge) continue;
    const ElementJudgement of_element = entry.kind->judge(*entry.element, model, result);
    judgement.criteria.insert(judgement.criteria.end(), of_element.criteria.begin(), of_element.criteria.end());
    judgement.caps.insert(judgement.caps.end(), of_element.caps.begin(), of_element.caps.end());
    if (contradiction.empty()) contradiction = of_element.distrust;
  }
  for (const Criterion& criterion : model.criteria) judgement.criteria.push_back(judge_criterion(criterion, result));
  judgement.has_criteria = !judgement.criteria.empty();
  judgement.so_far = judgement.has_criteria ? Verdict::hold : Verdict::open;
  for (const CriterionResult& c : judgement.criteria) judgement.so_far = std::max(judgement.so_far, c.outcome);
  judgement.verdict = failure.empty() ? judgement.so_far : Verdict::open;
  if (failure.empty()) {
    distrust(judgement, distrust_of(model, system, result));
    distrust(judgement, contradiction);
  }
  if (!judgement.caps.empty()) judgement.verdict = std::max(judgement.verdict, Verdict::open);
  return judgement;
}

std::vector<std::string> channels_of_trust(const Model& model) {
  std::vector<std::string> channels;
  for (const ElementEntry& entry : model.elements) {
    if (!entry.kind->channels_of_trust) continue;
    for (std::string& channel : entry.kind->channels_of_trust(*entry.element)) channels.push_back(std::move(channel));
  }
  return channels;
}

} // namespace steplap
