#include "mbd/io/unit_text.h"

#include <cctype>
#include <string_view>

namespace steplap {

namespace {

// A name that UDUNITS knows and most people use for another unit, also with a letter before it as prefix.
struct DoubtfulName {
  std::string_view name;
  std::string_view advice;
};
constexpr DoubtfulName k_doubtful[] = {
    {"e", "has the charge of an electron as its unit: write a number with its power of ten, as in '3e5 N'"},
    {"ton", "has a ton, which may be metric or not: write 't' for 1000 kg, or 'short_ton' for 907 kg"},
    {"tons", "has tons, which may be metric or not: write 't' for 1000 kg, or 'short_ton' for 907 kg"},
    {"kmph", "has the unknown unit 'kmph': write 'km/h'"},
    {"kmh", "has the unknown unit 'kmh': write 'km/h'"},
    {"kph", "has the unknown unit 'kph': write 'km/h'"}};

constexpr std::string_view k_letters[] = {"µ", "μ", "Ω", "Ω", "Å", "å", "°"}; // besides those of ASCII
constexpr std::string_view k_raised[] = {"¹", "²", "³"};                      // those that UDUNITS reads
constexpr std::string_view k_arc_signs[] = {"'", "\"", "′", "″", "’", "‘", "´"};
constexpr std::string_view k_spaces[] = {"\u00a0", "\u202f", "\u2009"}; // that stand between groups of digits

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class UnitText {
public:
  explicit UnitText(std::string_view text) : text_(text) {}

  // Returns the problem; "" if there is none.
  std::string problem() {
    std::string problem = separated_digits();
    if (problem.empty() && text_.starts_with("1/")) at_ = 2;
    while (problem.empty() && at_ < text_.size()) problem = part();
    return problem;
  }

private:
  // Consumes one name with its power, or one sign.
  std::string part() {
    if (is_digit(text_[at_])) return has_power_ && before_ == '/' ? no_power() : second_number();
    if (const std::size_t length = letter(); length > 0) return name();
    for (const std::string_view sign : k_arc_signs)
      if (rest().starts_with(sign))
        return "has the sign " + std::string(sign) + " in its unit: write the name of the unit, an angle as a decimal number of 'deg'";
    if (rest().starts_with("·")) return sign(2);
    if (rest().starts_with("**")) return no_power();
    if (std::string_view(" \t*./()").find(text_[at_]) != std::string_view::npos || (text_[at_] == '-' && is_between_names()))
      return sign(1);
    return text_[at_] == '^' ? no_power() : "has the unknown unit '" + std::string(text_) + "'";
  }

  std::string name() {
    const std::size_t begin = at_;
    const bool is_degree = rest().starts_with("°");
    std::size_t end = at_;
    while (at_ < text_.size()) { // digits within a name belong to it, as in "cmH2O"
      const std::size_t length = letter();
      if (length == 0 && !is_digit(text_[at_])) break;
      at_ += length > 0 ? length : 1;
      if (length > 0) end = at_;
    }
    at_ = end;
    if (is_degree && at_ < text_.size() && is_digit(text_[at_])) return "has a number after °: write an angle as a decimal number of 'deg'";
    const std::string_view word = text_.substr(begin, end - begin);
    for (const DoubtfulName& doubtful : k_doubtful)
      if (word == doubtful.name || (word.size() > 2 && word.size() == doubtful.name.size() + 1 && word.ends_with(doubtful.name)))
        return std::string(doubtful.advice);
    return power();
  }

  // Consumes a power, if there is one.
  std::string power() {
    has_power_ = false;
    before_ = 'a';
    for (const std::string_view raised : k_raised)
      if (rest().starts_with(raised)) {
        at_ += raised.size();
        has_power_ = true;
        return "";
      }
    const std::size_t begin = at_;
    if (rest().starts_with("**")) at_ += 2;
    else if (rest().starts_with("^")) ++at_;
    const bool is_marked = at_ > begin;
    if (at_ + 1 < text_.size() && text_[at_] == '-' && is_digit(text_[at_ + 1])) ++at_;
    const std::size_t digits = at_;
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    if (at_ == digits) return is_marked ? no_power() : "";
    has_power_ = true;
    const bool is_broken = at_ + 1 < text_.size() && text_[at_] == '.' && is_digit(text_[at_ + 1]);
    return is_broken || at_ - digits > 1 || text_[digits] == '0' ? no_power() : "";
  }

  std::string sign(std::size_t length) {
    if (text_[at_] == ')') {
      at_ += length;
      return power();
    }
    if (text_[at_] != ' ' && text_[at_] != '\t') before_ = text_[at_];
    at_ += length;
    return "";
  }

  // Returns the problem of a unit that continues the digits of the number before it.
  std::string separated_digits() const {
    const auto separates = [this](std::string_view sign) {
      return text_.starts_with(sign) && text_.size() > sign.size() && is_digit(text_[sign.size()]);
    };
    bool is_separated = separates("_");
    for (const std::string_view sign : k_arc_signs) is_separated = is_separated || separates(sign);
    for (const std::string_view sign : k_spaces) is_separated = is_separated || separates(sign);
    return is_separated ? "separates the digits of its number: write them together, as in '300000 N'" : "";
  }

  std::string second_number() const {
    return "has another number in its unit '" + std::string(text_) + "': write one number, its digits together, and a unit";
  }
  std::string no_power() const {
    return "has a power in its unit '" + std::string(text_) +
           "' that is not a whole number from 1 to 9 right after a name, as in 'm^2': write such a value as a number in SI";
  }

  // Returns the length of the letter here; 0 if there is another character.
  std::size_t letter() const {
    const char c = text_[at_];
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '%') return 1;
    for (const std::string_view other : k_letters)
      if (rest().starts_with(other)) return other.size();
    return 0;
  }
  bool is_between_names() const { return before_ == 'a' && at_ + 1 < text_.size() && UnitText(text_.substr(at_ + 1)).letter() > 0; }
  std::string_view rest() const { return text_.substr(at_); }

  std::string_view text_;
  std::size_t at_ = 0;
  bool has_power_ = false; // the name before has a power
  char before_ = ' ';      // sign before; 'a' for a name
};

} // namespace

std::string unit_text_problem(const std::string& unit) { return UnitText(unit).problem(); }

} // namespace steplap
