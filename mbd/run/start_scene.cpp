#include "mbd/run/start_scene.h"

#include "mbd/run/quantity_text.h"

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace steplap {

std::string three_digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value + 0.0);
  return text;
}

std::string short_length(double metres) { return quantity_text(std::strtod(three_digits(metres).c_str(), nullptr), "m"); }
std::string short_force(double value, const char* unit) { return quantity_text(std::strtod(three_digits(value).c_str(), nullptr), unit); }
std::string short_degrees(double radians) { return three_digits(radians * 180.0 / std::numbers::pi) + "°"; }

StartScene::StartScene(const LoadedModel& loaded_)
    : loaded(loaded_), system(*loaded_.system), start(beginning_of(loaded_, true)), balance(system, start),
      contacts(contacts_at(loaded_, start)) {}

void StartScene::add(const char* code, const Location& where, std::string text) {
  found.push_back({code, FindingLevel::warning, std::move(text), where});
}

} // namespace steplap
