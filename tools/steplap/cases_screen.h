// Prints the results of load cases within 80 columns: verdict, cases, limits, and the matrix of utilisations.
#pragma once

#include "mbd/run/load_cases.h"

#include <iosfwd>

namespace steplap {

void print_load_cases(std::ostream& out, const LoadCaseResults& results);

} // namespace steplap
