#include "tools/study/program/show.h"

#include "tools/steplap/text_table.h"
#include "tools/study/kinds.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

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

// Prints the reasons of failed runs with their counts. Reasons that differ in numbers only are counted together.
void show_reasons(Store& store, std::ostream& out) {
  constexpr std::size_t k_most = 20;
  struct Group {
    std::string key;
    Store::Reason first;
    bool is_alike = true;
  };
  std::vector<Group> groups;
  for (const Store::Reason& reason : store.reasons()) {
    if (reason.status == "ok") continue;
    std::string key = reason.status + " ";
    for (const char c : reason.reason)
      if (std::string("0123456789.+-e").find(c) == std::string::npos) key += c;
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.key == key; });
    if (same == groups.end()) {
      groups.push_back({key, reason});
      continue;
    }
    same->is_alike = false;
    const long count = same->first.count + reason.count;
    if (reason.first < same->first.first) same->first = reason;
    same->first.count = count;
  }
  for (std::size_t i = 0; i < std::min(groups.size(), k_most); ++i) {
    const Store::Reason& r = groups[i].first;
    out << "  " << r.count << " " << r.status << ", first sample " << r.first << ": " << r.reason
        << (groups[i].is_alike ? "" : " (others alike, with other numbers)") << "\n";
  }
  if (groups.size() > k_most) out << "  and " << groups.size() - k_most << " more reasons\n";
}

constexpr long k_most_samples = 20;

// Prints the values that a sweep has tried, with the results of their runs.
void show_samples(Store& store, std::ostream& out) {
  const StoreIdentity& identity = store.identity();
  std::vector<TextTable::Align> columns(1 + identity.variables.size() + identity.numbers.size(), TextTable::Align::right);
  std::vector<std::string> head{"sample"};
  for (const auto* names : {&identity.variables, &identity.numbers}) head.insert(head.end(), names->begin(), names->end());
  TextTable table(columns);
  table.set_head("samples", head);
  std::vector<StoredSample> samples;
  store.read(1, std::min(store.size(), k_most_samples), samples);
  for (const StoredSample& sample : samples) {
    TextTable::Row row{count_cell(static_cast<std::size_t>(sample.number))};
    for (const auto* values : {&sample.values, &sample.outcome.numbers})
      for (const double value : *values) row.push_back(Cell(digits(value), value));
    table.add_row(row);
  }
  out << table;
  if (store.size() > k_most_samples) out << "  … and " << store.size() - k_most_samples << " more samples, which export writes\n";
}

// Prints the files from which the study was made. Their digests are in the store.
void show_files(Store& store, std::ostream& out) {
  std::istringstream files(store.setting("files"));
  for (std::string line; std::getline(files, line);)
    if (const std::size_t space = line.find(' '); space != std::string::npos) out << "Read from " << line.substr(space + 1) << "\n";
}

} // namespace

void show(Store& store, const std::string& title, std::ostream& out) {
  const StudyKind* kind = find_kind(store.identity().kind);
  std::vector<std::string> notes = store.notes();
  if (kind && kind->begins_with_sentence && !notes.empty()) {
    out << notes.front() << "\n";
    notes.erase(notes.begin());
  }
  if (!title.empty()) out << title << "\n";
  const std::string standing = store.setting("standing");
  out << "Study of the kind '" << store.identity().kind << "', version " << store.identity().version << ": " << store.size() << " samples"
      << (standing.empty() ? ", not finished" : "") << "\n";
  show_reasons(store, out);
  if (store.identity().kind == "sweep") show_samples(store, out);
  std::vector<Finding> findings = store.findings();
  if (standing.empty()) {
    findings = store.growth();
    if (findings.size() > 1) findings = {findings.back()};
  }
  using Align = TextTable::Align;
  TextTable table({Align::left, Align::left, Align::left, Align::right, Align::left, Align::right, Align::left});
  if (!findings.empty())
    table.set_head("findings", {"method", "of", "quantity", "value", "interval", "samples", ""},
                   {"method", "of", "quantity", "value", "interval", "samples", "status"});
  for (const Finding& f : findings) {
    if (kind && std::any_of(kind->points.begin(), kind->points.end(), [&](const PointRole& p) { return p.is_for_page && p.has(f); }))
      continue;
    table.add_row({f.method, f.subject, f.quantity, Cell(digits(f.value), f.value), interval_text(f),
                   count_cell(static_cast<std::size_t>(f.samples)), f.status});
  }
  out << table;
  for (const std::string& note : notes) out << note << "\n";
  show_files(store, out);
  if (!standing.empty() && standing != "done") out << "Standing: " << standing << "\n";
}

} // namespace steplap::study
