// Store of a study: one SQLite file with the study, the models, every sample and every finding.
//
// Samples are numbered from 1 in the order of requests and are written in transactions, so the file always contains a complete initial
// sequence. Only one process writes. Opening a store checks all of it; a damaged store is rejected (store_check.cpp).
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/io/input_files.h"
#include "tools/study/finding.h"
#include "tools/study/sample_simulator.h"

struct sqlite3;
struct sqlite3_stmt;

namespace steplap::study {

/// Treatment of an existing store. run: continue; throw if the study has changed. changed: continue even then, with the samples that are
/// still valid. restart: delete all samples.
enum class StoreMode { run, changed, restart };

/// Thrown if the store cannot be used, with reason and remedy. Exit code 2.
class StoreError : public FileError {
public:
  /// `usable_modes` lists the modes with which the store could be used.
  StoreError(std::string path, const std::string& message, std::vector<StoreMode> usable_modes = {})
      : FileError(std::move(path), message), usable_modes_(std::move(usable_modes)) {}

  /// Returns the modes with which the store could be used.
  [[nodiscard]] const std::vector<StoreMode>& usable_modes() const { return usable_modes_; }

private:
  std::vector<StoreMode> usable_modes_;
};

/// Identity of a study in a store.
struct StoreIdentity {
  std::string version; ///< version of the program that wrote the store
  std::string study;   ///< text of the study file and of the files it extends
  std::string kind;
  /// text of everything that affects the numbers of a sample: models, variables, responses, limit states
  std::string scene;
  std::vector<std::string> variables, numbers; ///< column names of the samples
  bool has_curves = false;                     ///< true if samples contain the channel values at measured times
  std::vector<InputFile> files{};              ///< all files from which study and models were read
};
[[nodiscard]] StoreIdentity identity_of(const LoadedStudy& loaded);

/// A sample in the store.
struct StoredSample {
  long number = 0;
  std::vector<double> values;
  Outcome outcome;
};

/// An open store.
class Store {
public:
  /// Opens a store for a study, or creates it. A store of another study is rejected (StoreError), depending on `mode`.
  Store(const std::string& path, const StoreIdentity& identity, StoreMode mode);
  /// Opens a store for reading, whatever study it contains.
  explicit Store(const std::string& path);
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;
  ~Store();

  [[nodiscard]] const StoreIdentity& identity() const { return identity_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] long size() const { return size_; } ///< number of samples
  /// Returns true if the study was changed and not completed since. Some samples may then belong to the earlier version.
  [[nodiscard]] bool may_hold_others() { return !setting("changed").empty(); }
  /// Reads samples number `first` to `first` + `count` − 1, which must exist.
  void read(long first, long count, std::vector<StoredSample>& rows);
  /// Appends samples. They are on disk after half a second, or at the next append(), note() or flush() after that.
  void append(const StoredSample* rows, std::size_t count);
  void flush();
  /// Deletes all samples from `number` on.
  void forget_from(long number);
  /// Stores intermediate estimate number `place`, counted from 1.
  void note(long place, const Finding& finding);
  /// A point of a measured record with the fitted value at that time.
  struct CurvePoint {
    std::string history;
    double t = 0.0, measured = 0.0, fitted = 0.0; ///< time, s; measured and fitted value, in the unit of the channel
  };
  /// Replaces the measured records with their fitted values.
  void set_histories(const std::vector<CurvePoint>& points);
  [[nodiscard]] std::vector<CurvePoint> histories(); ///< empty if there are none
  /// Replaces findings, notes and standing.
  void set_findings(const std::vector<Finding>& findings, const std::vector<std::string>& notes, const std::string& standing);
  [[nodiscard]] std::vector<Finding> findings();
  /// Returns the intermediate estimates.
  [[nodiscard]] std::vector<Finding> growth();
  [[nodiscard]] std::vector<std::string> notes();
  [[nodiscard]] std::string setting(const std::string& key); ///< returns "" if the key does not exist
  /// Stores the description made by report_about.h. It is not part of the identity.
  void describe(const std::string& about);
  /// Starts a read transaction: all later reads see the present contents, even if another process writes.
  void hold();
  /// Returns the number of samples in which number i has a value. order_statistic() returns the value at position `place`, from 0, in
  /// ascending order.
  [[nodiscard]] long count_of(std::size_t i);
  [[nodiscard]] double order_statistic(std::size_t i, long place);
  /// A status of failed runs with one reason, its frequency, and the number of its first sample.
  struct Reason {
    std::string status, reason;
    long count = 0, first = 0;
  };
  [[nodiscard]] std::vector<Reason> reasons();

private:
  Store() = default; ///< called by the public constructors first, so that the destructor closes open files if they throw
  struct Statement;
  void open(const std::string& path, bool is_writing);
  bool is_cut_off();
  void lock();
  [[nodiscard]] bool is_empty();
  [[nodiscard]] long pragma(const char* name);
  void check_kind();
  void create(const StoreIdentity& identity);
  void execute(const std::string& sql);
  void begin();
  void commit_if_due();
  void set(const std::string& key, const std::string& value);
  void read_identity();
  void read_curves(long first, std::vector<StoredSample>& rows);
  void put(const std::string& table, long place, const Finding& finding);
  [[nodiscard]] std::vector<Finding> all_of(const std::string& table);
  [[nodiscard]] bool is_in_transaction() const;
  void end_reading() noexcept;
  [[noreturn]] void fail(const std::string& doing);
  [[noreturn]] void damaged(const std::string& why) const;
  [[nodiscard]] SampleStatus status_of(long status) const;
  static long fingerprint_of(const std::string& key, const std::string& value);
  static long fingerprint_of(const std::string& table, long place, const Finding& finding);
  static long fingerprint_of(long place, const CurvePoint& point);
  static std::string counts_text(std::size_t findings, std::size_t notes);
  static std::string files_text(const StoreIdentity& identity);
  [[nodiscard]] std::string changed_files(const StoreIdentity& now);
  void put_batch(const StoredSample* rows, std::size_t count);
  [[nodiscard]] long begin_of_batch(long number);
  void check();
  void check_pages();
  void check_settings();
  void check_samples();
  [[nodiscard]] std::string sample_columns() const;

  std::string path_;
  sqlite3* database_ = nullptr;
  int lock_file_ = -1;
  StoreIdentity identity_;
  long size_ = 0;
  bool is_open_ = false;   ///< true within a write transaction
  double committed_ = 0.0; ///< time of the last commit, s
};

} // namespace steplap::study
