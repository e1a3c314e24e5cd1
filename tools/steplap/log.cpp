#include "tools/steplap/log.h"

#include "mbd/base/shown_text.h"
#include "tools/steplap/colour.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/sinks/ostream_sink.h>

namespace steplap {

namespace {

spdlog::logger& logger() {
  static spdlog::logger instance("steplap");
  return instance;
}

} // namespace

void start_log(std::ostream& err, bool is_terminal) {
  spdlog::sink_ptr sink;
  if (is_terminal && !is_colour_refused()) sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_st>();
  else sink = std::make_shared<spdlog::sinks::ostream_sink_st>(err, true);
  sink->set_pattern("%n: %^%l%$: %v");
  logger().sinks() = {sink};
  set_log_level(Verbosity::normal);
}

void set_log_level(Verbosity verbosity) {
  switch (verbosity) {
  case Verbosity::quiet: return logger().set_level(spdlog::level::err);
  case Verbosity::normal: return logger().set_level(spdlog::level::info);
  case Verbosity::verbose: return logger().set_level(spdlog::level::debug);
  }
}

void log_error(const std::string& text) { logger().error(shown(text, true)); }
void log_warning(const std::string& text) { logger().warn(shown(text, true)); }
void log_info(const std::string& text) { logger().info(shown(text, true)); }
void log_detail(const std::string& text) { logger().debug(shown(text, true)); }

} // namespace steplap
