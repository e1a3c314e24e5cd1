// A store for people: samples, reasons of runs that failed, findings.
#pragma once

#include "tools/study/store.h"

#include <iosfwd>

namespace steplap::study {

void show(Store& store, const std::string& title, std::ostream& out);

} // namespace steplap::study
