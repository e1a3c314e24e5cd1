// Detects damage of a store by fingerprints of all data, which are checked whenever it is opened.
//
// Samples have one fingerprint per appended batch, all other data one per row. A damaged or manually edited store is rejected as a whole,
// because the damaged part cannot be determined.
#include "mbd/base/fingerprint.h"
#include "tools/study/store_statement.h"

#include <algorithm>

namespace steplap::study {

namespace {

long number_of(const Fingerprint& fingerprint) { return static_cast<long>(fingerprint.value()); }

void add(Fingerprint& fingerprint, const StoredSample& row) {
  const Outcome& o = row.outcome;
  fingerprint.add(row.number);
  fingerprint.add(static_cast<long>(o.status));
  fingerprint.add(std::string_view(o.reason));
  for (const double x : {o.error, o.evaluations, o.cpu_seconds}) fingerprint.add(x);
  for (const std::vector<double>* numbers : {&row.values, &o.numbers, &o.curve}) {
    fingerprint.add(static_cast<long>(numbers->size()));
    for (const double x : *numbers) fingerprint.add(x);
  }
}

long fingerprint_of(const StoredSample* rows, std::size_t count) {
  Fingerprint fingerprint;
  for (std::size_t i = 0; i < count; ++i) add(fingerprint, rows[i]);
  return number_of(fingerprint);
}

} // namespace

long Store::fingerprint_of(const std::string& key, const std::string& value) {
  Fingerprint fingerprint;
  fingerprint.add(std::string_view(key));
  fingerprint.add(std::string_view(value));
  return number_of(fingerprint);
}

long Store::fingerprint_of(const std::string& table, long place, const Finding& f) {
  Fingerprint fingerprint;
  fingerprint.add(place);
  for (const std::string* text : {&table, &f.method, &f.subject, &f.quantity, &f.status}) fingerprint.add(std::string_view(*text));
  for (const double x : {f.value, f.low, f.high}) fingerprint.add(x);
  fingerprint.add(f.samples);
  return number_of(fingerprint);
}

long Store::fingerprint_of(long place, const CurvePoint& p) {
  Fingerprint fingerprint;
  fingerprint.add(place);
  fingerprint.add(std::string_view(p.history));
  for (const double x : {p.t, p.measured, p.fitted}) fingerprint.add(x);
  return number_of(fingerprint);
}

void Store::damaged(const std::string& why) const {
  throw StoreError(path_,
                   "the store '" + path_ + "' is damaged, or was edited: " + why + ". Use a copy of it, or let the study create it again",
                   {StoreMode::restart});
}

SampleStatus Store::status_of(long status) const {
  if (status < 0 || status > static_cast<long>(SampleStatus::undecided))
    damaged("a sample has the status " + std::to_string(status) + ", which there is not");
  return static_cast<SampleStatus>(status);
}

std::string Store::counts_text(std::size_t findings, std::size_t notes) {
  return std::to_string(findings) + " findings, " + std::to_string(notes) + " notes";
}

std::string Store::files_text(const StoreIdentity& identity) {
  std::string text;
  for (const InputFile& file : identity.files) text += file.sha256 + " " + file.path + "\n";
  return text;
}

void Store::put_batch(const StoredSample* rows, std::size_t count) {
  if (count == 0) return;
  Statement s(*this, "INSERT INTO batch VALUES (?, ?)");
  s.bind(1, rows[count - 1].number);
  s.bind(2, study::fingerprint_of(rows, count));
  s.once();
}

long Store::begin_of_batch(long number) {
  Statement s(*this, "SELECT max(last) FROM batch WHERE last < ?");
  s.bind(1, number);
  return s.step() ? s.integer(0) + 1 : 1;
}

void Store::check() {
  const bool is_alone = !is_in_transaction();
  if (is_alone) execute("BEGIN"); // reads one consistent state, even if another process writes
  try {
    check_pages();
    check_settings();
    check_samples();
    const std::size_t found = findings().size(), noted = notes().size();
    (void)growth();
    (void)histories();
    if (!setting("standing").empty() && setting("answer") != counts_text(found, noted)) damaged("some of what was found is missing");
  } catch (...) {
    if (is_alone) end_reading();
    throw;
  }
  if (is_alone) end_reading();
}

void Store::check_pages() {
  Statement s(*this, "PRAGMA integrity_check(1)");
  if (!s.step() || s.text(0) != "ok") damaged(s.text(0));
}

void Store::check_settings() {
  std::vector<std::string> keys;
  {
    Statement s(*this, "SELECT key FROM setting");
    while (s.step()) keys.push_back(s.text(0));
  }
  for (const std::string& key : keys) (void)setting(key);
  for (const char* key : {"version", "study", "kind", "scene", "variables", "numbers", "files"})
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) damaged("what it says of '" + std::string(key) + "' is missing");
}

void Store::check_samples() {
  Statement s(*this, "SELECT last, fingerprint FROM batch ORDER BY last");
  long done = 0;
  std::vector<StoredSample> rows;
  while (s.step()) {
    const long last = s.integer(0);
    if (last <= done || last > size_) damaged("its batches are not those that were written");
    read(done + 1, last - done, rows);
    if (study::fingerprint_of(rows.data(), rows.size()) != s.integer(1))
      damaged("samples " + std::to_string(done + 1) + " to " + std::to_string(last) + " are not what was written");
    done = last;
  }
  if (done != size_) damaged("samples " + std::to_string(done + 1) + " to " + std::to_string(size_) + " belong to no batch");
}

} // namespace steplap::study
