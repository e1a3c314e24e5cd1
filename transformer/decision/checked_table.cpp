#include "transformer/decision/checked_table.h"

#include "mbd/model/validate.h"

namespace steplap::assess {

void read_checked_table(const Node& table, const FieldTable& fields, void* object, const TableReading& reading,
                        std::vector<Diagnostic>& problems) {
  for (const GivenField& given : read_fields(table, fields, object, reading, problems)) {
    if (!given.is_usable) continue;
    const std::string problem =
        given.node ? range_problem(*given.field, given.field->get(object)) : missing_field_message(*given.field, reading.subject);
    if (problem.empty()) continue;
    problems.push_back({given.node ? given.node->where() : table.where(),
                        given.node ? "'" + given.field->name + "' of " + reading.subject + " " + problem : problem});
  }
}

} // namespace steplap::assess
