#include "mbd/model/action.h"

#include <array>
#include <cctype>
#include <stdexcept>

namespace steplap {

namespace {

struct Verb {
  ActionVerb verb;
  const char* word;
};
constexpr std::array<Verb, 6> k_verbs{{{ActionVerb::release, "release"},
                                       {ActionVerb::hold, "hold"},
                                       {ActionVerb::set, "set"},
                                       {ActionVerb::arm, "arm"},
                                       {ActionVerb::disarm, "disarm"},
                                       {ActionVerb::stop, "stop"}}};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::string unquoted(const std::string& text) {
  const std::string inner = trimmed(text);
  const bool is_quoted = inner.size() > 1 && (inner.front() == '\'' || inner.front() == '"') && inner.back() == inner.front();
  return is_quoted ? trimmed(inner.substr(1, inner.size() - 2)) : inner;
}

[[noreturn]] void fail(const std::string& text) {
  throw std::invalid_argument(
      "'" + text +
      "' is nothing that an action does: write \"release NAME\", \"hold NAME\", \"set NAME.field = value\", \"arm ACTION\", "
      "\"disarm ACTION\" or \"stop\"");
}

} // namespace

const Action* as_action(const Element& element) { return dynamic_cast<const Action*>(&element); }

ActionStepText action_step(const std::string& text) {
  const std::string whole = trimmed(text);
  const std::size_t space = std::min(whole.find(' '), whole.size());
  const std::string word = whole.substr(0, space), rest = trimmed(whole.substr(space));
  for (const Verb& known : k_verbs) {
    if (word != known.word) continue;
    ActionStepText step;
    step.verb = known.verb;
    if (rest.empty() != (step.verb == ActionVerb::stop)) fail(text);
    step.name = rest;
    if (step.verb != ActionVerb::set) return step;
    const std::size_t equals = rest.find('=');
    if (equals == std::string::npos) fail(text);
    const std::string target = trimmed(rest.substr(0, equals));
    const std::size_t point = target.rfind('.');
    step.value = unquoted(rest.substr(equals + 1));
    if (point == std::string::npos || point == 0 || point + 1 == target.size() || step.value.empty()) fail(text);
    step.name = target.substr(0, point);
    step.field = target.substr(point + 1);
    return step;
  }
  fail(text);
}

std::string text_of(const ActionStepText& step) {
  std::string text;
  for (const Verb& known : k_verbs)
    if (known.verb == step.verb) text = known.word;
  if (!step.name.empty()) text += " " + step.name;
  if (step.verb == ActionVerb::set) text += "." + step.field + " = " + step.value;
  return text;
}

std::optional<EventText> event_text(const std::string& when) {
  const std::string text = trimmed(when);
  for (std::size_t space = text.find(' '); space != std::string::npos; space = text.find(' ', space + 1)) {
    const auto kind = event_kind_called(trimmed(text.substr(space)));
    const bool is_compared = text.find_first_of("<>=") < space; // "t > opens" is a comparison, with a parameter called "opens"
    if (kind && !is_compared) return EventText{trimmed(text.substr(0, space)), *kind};
  }
  return std::nullopt;
}

std::optional<std::vector<std::string>> items_of_list(const std::string& value) {
  const std::string whole = trimmed(value);
  if (whole.size() < 2 || whole.front() != '[' || whole.back() != ']') return std::nullopt;
  std::vector<std::string> items{""};
  int depth = 0;
  for (const char c : whole.substr(1, whole.size() - 2)) {
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (depth < 0) return std::nullopt;
    if (c == ',' && depth == 0) items.emplace_back();
    else items.back() += c;
  }
  if (depth != 0) return std::nullopt;
  for (std::string& item : items) item = unquoted(item);
  if (items.back().empty()) items.pop_back(); // comma after the last item
  return items;
}

bool is_name_in_step(const std::string& value) {
  const auto c = static_cast<unsigned char>(value.empty() ? '0' : value.front());
  return std::isdigit(c) == 0 && c != '.' && c != '-' && c != '+' && c != '[';
}

} // namespace steplap
