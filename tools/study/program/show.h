// Prints a store: samples, reasons of failed runs, findings.
#pragma once

#include "tools/study/store.h"

#include <iosfwd>

namespace steplap::study {

void show(Store& store, const std::string& title, std::ostream& out);

} // namespace steplap::study
