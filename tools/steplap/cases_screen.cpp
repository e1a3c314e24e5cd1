#include "tools/steplap/cases_screen.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/shown_quantity.h"
#include "tools/steplap/text_layout.h"
#include "tools/steplap/text_table.h"

#include <algorithm>
#include <cctype>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr std::size_t k_columns = 80, k_name = 25, k_quantity = 12; // widths of screen, names and quantities, in characters
constexpr std::size_t k_cases_in_row = 6;                           // columns of the matrix; more cases are printed in further tables

std::string name_text(const std::string& name) { return cut(shown(name), k_name); }

// Returns the utilisation, or the outcome of a limit that has none. "?" marks an open outcome.
std::string use_text(const CaseLimit* limit) {
  if (!limit) return "-";
  const Verdict outcome = limit->result.outcome;
  if (limit->share) return shown_share(*limit->share, limit->share_error) + (outcome == Verdict::open ? " ?" : "");
  return outcome == Verdict::hold ? "met" : outcome == Verdict::open ? "open" : "not met";
}

std::string cell_text(const std::optional<double>& value, const std::string& unit, ShownDigits digits = {}) {
  return value ? cut(shown_quantity(*value, unit, {}, digits), k_quantity) : "-";
}

void print_cases(std::ostream& out, const std::vector<CaseResult>& cases) {
  TextTable table({Align::right, Align::left, Align::left, Align::left, Align::right});
  table.add_row({"", "case", "verdict", "governing limit", "used"});
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const CaseLimit* const governing = cases[k].governing();
    table.add_row({std::to_string(k + 1), name_text(cases[k].load.name), name_of(cases[k].judgement.verdict),
                   governing ? name_text(governing->name) : "-", use_text(governing)});
  }
  out << table;
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (cases[k].judgement.verdict != Verdict::hold)
      out << wrapped("  " + std::to_string(k + 1) + ": " + shown(cases[k].reason), k_columns, 5, 4) << "\n";
}

// Cuts the names in the first column so that the table fits on the screen. Numbers keep their digits and units.
void cut_names(std::vector<TextTable::Row>& rows) {
  std::size_t others = 2; // starts with the indent of the table
  for (std::size_t i = 1; i < rows.front().size(); ++i) {
    std::size_t widest = 0;
    for (const TextTable::Row& row : rows) widest = std::max(widest, width_of(row[i].text));
    others += 2 + widest;
  }
  for (TextTable::Row& row : rows) row.front().text = cut(row.front().text, k_columns - others);
}

void print_limits(std::ostream& out, const std::vector<LimitRow>& limits) {
  std::vector<TextTable::Row> rows{{"limit", "case", "value", "at limit", "margin", "error"}};
  for (const LimitRow& limit : limits) {
    const CriterionResult& worst = limit.in_case[limit.governing]->result;
    rows.push_back({name_text(limit.name), std::to_string(limit.governing + 1), cell_text(worst.value, worst.unit),
                    cell_text(worst.limit, worst.unit), cell_text(worst.reserve, worst.unit),
                    cell_text(worst.error, worst.unit, {.most = 1})});
  }
  cut_names(rows);
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right});
  for (TextTable::Row& row : rows) table.add_row(std::move(row));
  out << "\n" << table;
}

// Prints the columns of the cases from `first` on.
void print_matrix(std::ostream& out, const std::vector<LimitRow>& rows, std::size_t first, std::size_t end) {
  std::vector<Align> columns(1 + end - first, Align::right);
  columns.front() = Align::left;
  TextTable table(columns);
  TextTable::Row head{"used of limit, case"};
  for (std::size_t k = first; k < end; ++k) head.push_back(std::to_string(k + 1));
  table.add_row(head);
  for (const LimitRow& row : rows) {
    TextTable::Row cells{name_text(row.name)};
    for (std::size_t k = first; k < end; ++k) cells.push_back(use_text(row.in_case[k]));
    table.add_row(cells);
  }
  out << "\n" << table;
}

} // namespace

void print_load_cases(std::ostream& out, const LoadCaseResults& results) {
  std::string verdict = name_of(results.verdict());
  std::transform(verdict.begin(), verdict.end(), verdict.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  out << wrapped(verdict + "  " + shown(results.reason()), k_columns, verdict.size() + 2, 4) << "\n";
  for (const auto& model : results.models) {
    const std::string& title = model->model.header.title;
    out << cut(shown(model->name + (title.empty() ? "" : ": " + title)), k_columns) << "\n";
  }
  out << "\n";
  print_cases(out, results.cases);
  const std::vector<LimitRow> rows = limit_rows(results);
  print_limits(out, rows);
  for (std::size_t first = 0; first < results.cases.size(); first += k_cases_in_row)
    print_matrix(out, rows, first, std::min(first + k_cases_in_row, results.cases.size()));
}

} // namespace steplap
