#include "mbd/base/stop.h"

namespace steplap {

namespace {

thread_local const StopQuestion* asked = nullptr;

} // namespace

StopScope::StopScope(const StopQuestion& question) : before_(asked) {
  if (question) asked = &question;
}

StopScope::~StopScope() { asked = before_; }

void throw_if_stopped(const char* where) {
  if (!asked) return;
  if (const std::string why = (*asked)(); !why.empty()) throw RunStopped(why + " " + where + ".");
}

} // namespace steplap
