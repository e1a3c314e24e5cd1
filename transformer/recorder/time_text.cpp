#include "transformer/recorder/time_text.h"

#include "transformer/recorder/fields.h"

#include <array>
#include <cstdio>

namespace steplap {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Parses digits at the front of the text. Returns false if there are fewer than `least` or more than `most`.
bool take_digits(std::string_view& text, std::size_t least, std::size_t most, int& value, std::size_t& count) {
  value = 0;
  for (count = 0; count < text.size() && is_digit(text[count]) && count < most; ++count) value = value * 10 + (text[count] - '0');
  if (count < least || (count < text.size() && is_digit(text[count]))) return false;
  text.remove_prefix(count);
  return true;
}

// Parses a month's name at the front of the text. Returns 1 to 12; 0 if there is none.
int take_month_name(std::string_view& text) {
  constexpr std::array<const char*, 12> k_months = {"jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"};
  std::size_t letters = 0;
  while (letters < text.size() && ((text[letters] | 0x20) >= 'a' && (text[letters] | 0x20) <= 'z')) ++letters;
  if (letters < 3) return 0;
  const std::string name = lower_case(text.substr(0, 3));
  for (std::size_t i = 0; i < k_months.size(); ++i)
    if (name == k_months[i]) {
      text.remove_prefix(letters);
      return static_cast<int>(i) + 1;
    }
  return 0;
}

int days_in(int year, int month) {
  constexpr std::array<int, 12> k_days = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return k_days[static_cast<std::size_t>(month - 1)] + (month == 2 && is_leap ? 1 : 0);
}

bool is_valid_date(int year, int month, int day) {
  return year >= 1970 && year < 2200 && month >= 1 && month <= 12 && day >= 1 && day <= days_in(year, month);
}

// Returns the days since 1970-01-01 in the proleptic Gregorian calendar, by eras of 400 years that begin in March.
std::int64_t days_since_1970(int year, int month, int day) {
  const int y = month <= 2 ? year - 1 : year, era = y / 400, of_era = y - era * 400;
  const int of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int day_of_era = of_era * 365 + of_era / 4 - of_era / 100 + of_year;
  return std::int64_t{era} * 146097 + day_of_era - 719468;
}

struct DateParts {
  int first = 0, second = 0, third = 0; ///< numbers in the order of the text; a month's name as its number
  std::size_t first_digits = 0, third_digits = 0;
  int named = 0; ///< position (1 or 2) of a month's name; 0: none
  char separator = 0;
};

// Parses the three parts of a date at the front of the text.
std::optional<DateParts> take_date(std::string_view& text) {
  DateParts parts;
  std::size_t count = 0;
  if (const int month = take_month_name(text)) {
    parts.first = month;
    parts.named = 1;
  } else if (!take_digits(text, 1, 4, parts.first, parts.first_digits)) {
    return std::nullopt;
  }
  if (text.empty()) return std::nullopt;
  parts.separator = text.front();
  if (parts.separator != '-' && parts.separator != '/' && parts.separator != '.' && parts.separator != ' ') return std::nullopt;
  text.remove_prefix(1);
  if (parts.named == 0) {
    if (const int month = take_month_name(text)) {
      parts.second = month;
      parts.named = 2;
    }
  }
  if (parts.named != 2 && !take_digits(text, 1, 2, parts.second, count)) return std::nullopt;
  if (parts.separator == ' ' && parts.named == 0) return std::nullopt;
  if (text.starts_with(',') && parts.named == 1) text.remove_prefix(1);
  if (text.empty() || text.front() != parts.separator) return std::nullopt;
  text.remove_prefix(1);
  if (!take_digits(text, 1, 4, parts.third, parts.third_digits)) return std::nullopt;
  return parts;
}

bool is_year(std::size_t digits) { return digits == 4 || digits == 2; }
int full_year(int year, std::size_t digits) { return digits == 2 ? 2000 + year : year; }

bool fits(const DateParts& p, unsigned order, int& year, int& month, int& day) {
  if (order == k_year_first) {
    year = full_year(p.first, p.first_digits), month = p.second, day = p.third;
    return p.named != 1 && is_year(p.first_digits) && p.third_digits <= 2 && is_valid_date(year, month, day);
  }
  year = full_year(p.third, p.third_digits);
  const bool is_month_first = order == k_month_first;
  month = is_month_first ? p.first : p.second;
  day = is_month_first ? p.second : p.first;
  if (p.named != 0 && is_month_first != (p.named == 1)) return false;
  return p.first_digits <= 2 && is_year(p.third_digits) && is_valid_date(year, month, day);
}

unsigned orders_of(const DateParts& parts) {
  int year = 0, month = 0, day = 0;
  if (parts.first_digits == 4) return fits(parts, k_year_first, year, month, day) ? unsigned{k_year_first} : 0U;
  unsigned orders = 0;
  for (const unsigned order : {unsigned{k_year_first}, unsigned{k_day_first}, unsigned{k_month_first}})
    if (fits(parts, order, year, month, day)) orders |= order;
  if (parts.third_digits == 4) orders &= ~unsigned{k_year_first};
  if (parts.separator == '.' && (orders & k_day_first) && parts.third_digits == 4) orders = k_day_first;
  return orders;
}

// Parses hh:mm[:ss[.fraction]] [AM|PM] at the front of the text.
bool take_clock(std::string_view& text, std::int64_t& ns) {
  int hour = 0, minute = 0, second = 0;
  std::size_t count = 0;
  if (!take_digits(text, 1, 2, hour, count) || !text.starts_with(':')) return false;
  text.remove_prefix(1);
  if (!take_digits(text, 2, 2, minute, count)) return false;
  std::int64_t fraction = 0;
  if (text.starts_with(':')) {
    text.remove_prefix(1);
    if (!take_digits(text, 2, 2, second, count)) return false;
    if (text.size() > 1 && (text.front() == '.' || text.front() == ',' || text.front() == ':') && is_digit(text[1])) {
      text.remove_prefix(1);
      std::int64_t place = k_second_ns / 10;
      for (count = 0; !text.empty() && is_digit(text.front()); text.remove_prefix(1), place /= 10, ++count)
        fraction += place * (text.front() - '0');
      if (count > 18) return false;
    }
  }
  std::string_view rest = text;
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  const std::string half = lower_case(rest.substr(0, 2));
  if (half == "am" || half == "pm") {
    if (hour < 1 || hour > 12) return false;
    hour = hour % 12 + (half == "pm" ? 12 : 0);
    text = rest.substr(2);
  }
  if (hour > 23 || minute > 59 || second > 59) return false;
  ns = ((hour * 60 + minute) * 60 + second) * k_second_ns + fraction;
  return true;
}

// Parses Z, UTC, +hh:mm, +hhmm, +hh. `ahead_ns` receives the offset from UTC, ns.
bool take_zone(std::string_view& text, std::int64_t& ahead_ns) {
  ahead_ns = 0;
  if (text == "Z" || text == "z" || text == "UTC" || text == "GMT") {
    text = {};
    return true;
  }
  if (!text.starts_with('+') && !text.starts_with('-')) return false;
  const int sign = text.front() == '-' ? -1 : 1;
  text.remove_prefix(1);
  std::string digits;
  for (const char c : text)
    if (is_digit(c)) digits += c;
    else if (c != ':' || digits.size() != 2) return false;
  if (digits.size() != 2 && digits.size() != 4) return false;
  const int hours = std::stoi(digits.substr(0, 2)), minutes = digits.size() == 4 ? std::stoi(digits.substr(2)) : 0;
  if (hours > 14 || minutes > 59) return false;
  ahead_ns = sign * (hours * 60 + minutes) * 60 * k_second_ns;
  text = {};
  return true;
}

} // namespace

unsigned possible_date_orders(std::string_view text) {
  const auto parts = take_date(text);
  if (!parts || (!text.empty() && text.front() != ' ' && text.front() != 'T' && text.front() != ',')) return 0;
  return orders_of(*parts);
}

std::optional<Stamp> parse_stamp(std::string_view text, unsigned order) {
  Stamp stamp;
  std::string_view rest = text;
  if (const auto parts = take_date(rest)) {
    int year = 0, month = 0, day = 0;
    if (!(orders_of(*parts) & order) || !fits(*parts, order, year, month, day)) return std::nullopt;
    stamp.ns = days_since_1970(year, month, day) * k_day_ns;
    stamp.has_date = true;
    if (rest.empty()) return stamp;
    if (rest.front() != ' ' && rest.front() != 'T' && rest.front() != ',') return std::nullopt;
    rest.remove_prefix(1);
    while (rest.starts_with(' ')) rest.remove_prefix(1);
  } else {
    rest = text;
  }
  std::int64_t clock = 0, ahead = 0;
  if (!take_clock(rest, clock)) return std::nullopt;
  stamp.has_clock = true;
  stamp.ns += clock;
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  if (rest.empty()) return stamp;
  if (!take_zone(rest, ahead)) return std::nullopt;
  stamp.has_zone = true;
  stamp.ns -= ahead;
  return stamp;
}

std::string stamp_text(std::int64_t ns) {
  std::int64_t days = ns / k_day_ns, rest = ns % k_day_ns;
  if (rest < 0) {
    rest += k_day_ns;
    --days;
  }
  // Converts days since 1970 to a date, by the eras of days_since_1970().
  const std::int64_t z = days + 719468, era = z / 146097, of_era = z - era * 146097;
  const std::int64_t year_of_era = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
  const std::int64_t of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100), shifted = (5 * of_year + 2) / 153;
  const int day = static_cast<int>(of_year - (153 * shifted + 2) / 5 + 1),
            month = static_cast<int>(shifted < 10 ? shifted + 3 : shifted - 9);
  const int year = static_cast<int>(year_of_era + era * 400 + (month <= 2 ? 1 : 0));
  const auto seconds = static_cast<int>(rest / k_second_ns);
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02d %02d:%02d:%02d.%06d", year, month, day, seconds / 3600, seconds / 60 % 60,
                seconds % 60, static_cast<int>(rest % k_second_ns / 1000));
  std::string result = text.data();
  while (result.ends_with("000") && result.find('.') != std::string::npos && result.size() > 23) result.resize(result.size() - 3);
  return result;
}

} // namespace steplap
