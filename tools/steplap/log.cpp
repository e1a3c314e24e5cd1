#include "tools/steplap/log.h"

#include "mbd/base/shown_text.h"

#include <cstdlib>
#include <iostream>
#include <string_view>

namespace steplap {

namespace {

enum class Level { detail, info, warning, error };

struct Log {
  std::ostream* stream = &std::cerr;
  bool is_coloured = false;
  Level least = Level::info;
};

Log& log_of_program() {
  static Log log;
  return log;
}

struct LevelText {
  const char *name, *colour;
};

LevelText text_of(Level level) {
  switch (level) {
  case Level::detail: return {"debug", "\033[36m"};
  case Level::info: return {"info", "\033[32m"};
  case Level::warning: return {"warning", "\033[33m\033[1m"};
  case Level::error: break;
  }
  return {"error", "\033[31m\033[1m"};
}

void write(Level level, const std::string& text) {
  const Log& log = log_of_program();
  if (level < log.least) return;
  const LevelText name = text_of(level);
  std::string line = "steplap: ";
  line += log.is_coloured ? std::string(name.colour) + name.name + "\033[m" : std::string(name.name);
  line += ": " + shown(text, true) + "\n";
  *log.stream << line << std::flush;
}

bool takes_colours() {
  const char* terminal = std::getenv("TERM");
  return terminal && *terminal && std::string_view(terminal) != "dumb";
}

} // namespace

void start_log(std::ostream& err, bool is_terminal) {
  log_of_program() = {&err, is_terminal && takes_colours(), Level::info};
}

void set_log_level(Verbosity verbosity) {
  Level& least = log_of_program().least;
  switch (verbosity) {
  case Verbosity::quiet:
    least = Level::error;
    return;
  case Verbosity::normal:
    least = Level::info;
    return;
  case Verbosity::verbose:
    least = Level::detail;
    return;
  }
}

void log_error(const std::string& text) { write(Level::error, text); }
void log_warning(const std::string& text) { write(Level::warning, text); }
void log_info(const std::string& text) { write(Level::info, text); }
void log_detail(const std::string& text) { write(Level::detail, text); }

} // namespace steplap
