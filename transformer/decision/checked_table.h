// Reads tables of the files that belong to a decision, and collects all their problems.
#pragma once

#include "mbd/io/field_reader.h"

#include <vector>

namespace steplap::assess {

/// Reads `table` into `object`, and appends a problem with its location for each field that is missing or outside its range.
void read_checked_table(const Node& table, const FieldTable& fields, void* object, const TableReading& reading,
                        std::vector<Diagnostic>& problems);

} // namespace steplap::assess
