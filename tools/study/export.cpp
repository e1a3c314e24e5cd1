#include "tools/study/export.h"

#include "mbd/base/number_text.h"
#include "mbd/io/csv.h"
#include "tools/study/finding_part.h"

#include <ostream>

namespace steplap::study {

void export_samples(Store& store, std::ostream& out) {
  constexpr long k_block = 10000;
  std::string text = "number,status,reason,error,evaluations";
  for (const std::string& name : store.identity().variables) text += "," + name;
  for (const std::string& name : store.identity().numbers) text += "," + name;
  text += "\n";
  std::vector<StoredSample> rows;
  for (long first = 1; first <= store.size(); first += k_block) {
    store.read(first, std::min(k_block, store.size() - first + 1), rows);
    for (const StoredSample& row : rows) {
      text += std::to_string(row.number) + "," + name_of(row.outcome.status) + "," + csv_field(row.outcome.reason) + ",";
      append_number(text, row.outcome.error);
      text += ",";
      append_number(text, row.outcome.evaluations);
      for (const std::vector<double>* numbers : {&row.values, &row.outcome.numbers})
        for (const double x : *numbers) {
          text += ",";
          append_number(text, x);
        }
      text += "\n";
    }
    out << text;
    text.clear();
  }
  out << text;
}

void export_histories(const std::vector<Store::CurvePoint>& points, std::ostream& out) {
  std::string text = "history,t,measured,fitted\n";
  for (const Store::CurvePoint& p : points) {
    text += csv_field(p.history);
    for (const double x : {p.t, p.measured, p.fitted}) {
      text += ",";
      append_number(text, x);
    }
    text += "\n";
  }
  out << text;
}

long export_posterior(const std::vector<Finding>& findings, std::ostream& out) {
  const PointRole role{"evidence", "posterior sample"};
  std::string head, text, sample;
  long rows = 0;
  for (const Finding& f : findings) {
    if (!role.has(f)) continue;
    const bool is_new = rows == 0 || f.subject != sample;
    if (is_new && rows > 0) text += "\n";
    rows += is_new;
    if (rows == 1) head += (head.empty() ? "" : ",") + f.quantity;
    if (!is_new) text += ",";
    append_number(text, f.value);
    sample = f.subject;
  }
  if (rows > 0) out << head << "\n" << text << "\n";
  return rows;
}

void export_findings(const std::vector<Finding>& findings, std::ostream& out) {
  std::string text = "method,subject,quantity,value,low,high,samples,status\n";
  for (const Finding& f : findings) {
    text += csv_field(f.method) + "," + csv_field(f.subject) + "," + csv_field(f.quantity);
    for (const double x : {f.value, f.low, f.high}) {
      text += ",";
      append_number(text, x);
    }
    text += "," + std::to_string(f.samples) + "," + csv_field(f.status) + "\n";
  }
  out << text;
}

} // namespace steplap::study
