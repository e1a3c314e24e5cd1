#include "tools/study/show.h"

#include "tools/steplap/text_table.h"

#include <cmath>
#include <ostream>

namespace steplap::study {

namespace {

std::string digits(double value) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.8g", value);
  return text;
}

std::string interval_text(const Finding& f) {
  if (std::isnan(f.low) && std::isnan(f.high)) return "";
  return "[" + digits(f.low) + ", " + digits(f.high) + "]";
}

} // namespace

void show(Store& store, const std::string& title, std::ostream& out) {
  if (!title.empty()) out << title << "\n";
  const std::string standing = store.setting("standing");
  out << "Study of the kind '" << store.identity().kind << "', version " << store.identity().version << ": " << store.size() << " samples"
      << (standing.empty() ? ", not finished" : "") << "\n";
  constexpr int k_most = 20;
  int shown = 0;
  for (const Store::Reason& reason : store.reasons()) {
    if (reason.status == "ok" || ++shown > k_most) continue;
    out << "  " << reason.count << " " << reason.status << ", first sample " << reason.first << ": " << reason.reason << "\n";
  }
  if (shown > k_most) out << "  and " << shown - k_most << " more reasons\n";
  std::vector<Finding> findings = store.findings();
  if (standing.empty()) {
    findings = store.growth();
    if (findings.size() > 1) findings = {findings.back()};
  }
  using Align = TextTable::Align;
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::left, Align::right, Align::left});
  if (!findings.empty()) table.add_row({"method", "of", "quantity", "value", "interval", "samples", ""});
  for (const Finding& f : findings)
    table.add_row({f.method, f.subject, f.quantity, digits(f.value), interval_text(f), std::to_string(f.samples), f.status});
  out << table;
  for (const std::string& note : store.notes()) out << note << "\n";
  if (!standing.empty() && standing != "done") out << "Standing: " << standing << "\n";
}

} // namespace steplap::study
