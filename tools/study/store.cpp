#include "tools/study/store.h"

#include "tools/study/store_statement.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace steplap::study {

namespace {

// Version of the database layout. Other versions are rejected.
constexpr int k_layout = 2;
constexpr int k_application = 0x73746c70; // application id in the header of the file, "stlp"

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

Store::Statement::Statement(Store& store, const std::string& sql) : store_(store) {
  if (sqlite3_prepare_v2(store.database_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) store.fail("used");
}
Store::Statement::~Statement() { sqlite3_finalize(statement); }

void Store::Statement::bind(int i, double x) { std::isnan(x) ? sqlite3_bind_null(statement, i) : sqlite3_bind_double(statement, i, x); }
void Store::Statement::bind(int i, long n) { sqlite3_bind_int64(statement, i, n); }
void Store::Statement::bind(int i, const std::string& text) {
  sqlite3_bind_text(statement, i, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}
void Store::Statement::bind(int i, const std::vector<double>& numbers) {
  sqlite3_bind_blob(statement, i, numbers.data(), static_cast<int>(numbers.size() * sizeof(double)), SQLITE_TRANSIENT);
}
void Store::Statement::take(int i, std::vector<double>& numbers) const {
  numbers.resize(static_cast<std::size_t>(sqlite3_column_bytes(statement, i)) / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), sqlite3_column_blob(statement, i), numbers.size() * sizeof(double));
}
bool Store::Statement::step() {
  const int code = sqlite3_step(statement);
  if (code != SQLITE_ROW && code != SQLITE_DONE) store_.fail("used");
  return code == SQLITE_ROW;
}
void Store::Statement::once() {
  (void)step();
  sqlite3_reset(statement);
}
double Store::Statement::number(int i) const {
  const int type = sqlite3_column_type(statement, i);
  if (type == SQLITE_TEXT || type == SQLITE_BLOB) store_.damaged("a number is none");
  return type == SQLITE_NULL ? std::nan("") : sqlite3_column_double(statement, i);
}
long Store::Statement::integer(int i) const {
  const int type = sqlite3_column_type(statement, i);
  if (type != SQLITE_INTEGER && type != SQLITE_NULL) store_.damaged("a whole number is none");
  return sqlite3_column_int64(statement, i);
}
std::string Store::Statement::text(int i) const {
  const int type = sqlite3_column_type(statement, i);
  if (type != SQLITE_TEXT && type != SQLITE_NULL) store_.damaged("a text is none");
  const unsigned char* bytes = sqlite3_column_text(statement, i);
  return bytes ? std::string(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(sqlite3_column_bytes(statement, i))) : "";
}

void Store::fail(const std::string& doing) {
  const int code = sqlite3_extended_errcode(database_), kind = code & 0xff;
  std::string why = database_ ? sqlite3_errmsg(database_) : "no memory";
  if (kind == SQLITE_FULL || code == SQLITE_IOERR_WRITE)
    why = "the disk is full, or a quota used up; what was finished before is kept: make room and run the study again";
  if (code == SQLITE_READONLY_ROLLBACK)
    why = "its last batch was cut off, and where it lies it cannot be written to take that back: copy it, with the file "
          "'" +
          path_ + "-journal', to where it can";
  else if (kind == SQLITE_READONLY || kind == SQLITE_CANTOPEN || kind == SQLITE_PERM)
    why = "it, or its folder, cannot be written (" + why + ")";
  if (kind == SQLITE_NOTADB) why = "it is no store of a study";
  if (kind == SQLITE_CORRUPT) why = "it is damaged (" + why + ")";
  if (kind == SQLITE_BUSY) why = "another process holds it";
  throw StoreError(path_, "the store '" + path_ + "' cannot be " + doing + ": " + why);
}

void Store::execute(const std::string& sql) {
  if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail("used");
}

bool Store::is_in_transaction() const { return sqlite3_get_autocommit(database_) == 0; }
void Store::end_reading() noexcept { sqlite3_exec(database_, "COMMIT", nullptr, nullptr, nullptr); }

void Store::begin() {
  if (!is_open_) execute("BEGIN IMMEDIATE");
  is_open_ = true;
}

void Store::flush() {
  if (is_open_) execute("COMMIT");
  is_open_ = false;
  committed_ = now();
}

// Commits when half a second has passed since the last commit. Each takes some hundredths of a second, so small batches share a
// transaction.
void Store::commit_if_due() {
  constexpr double k_due = 0.5; // interval between commits, s
  if (now() - committed_ > k_due) flush();
}

// Locks the store against other writers. A separate lock file is used, because SQLite's lock would also exclude readers. It stays open as
// long as the database.
void Store::lock() {
  lock_file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_file_ < 0) throw StoreError(path_, "the store '" + path_ + "' cannot be written: " + std::string(std::strerror(errno)));
  if (flock(lock_file_, LOCK_EX | LOCK_NB) != 0)
    throw StoreError(path_, "another process is writing to the store '" + path_ + "': wait for it, or choose another store");
}

// Returns true if an interrupted write (killed process, full disk) left an incomplete transaction. Rolling it back requires write access.
bool Store::is_cut_off() {
  sqlite3_exec(database_, "SELECT 1 FROM sqlite_master LIMIT 1", nullptr, nullptr, nullptr);
  return sqlite3_extended_errcode(database_) == SQLITE_READONLY_ROLLBACK;
}

void Store::open(const std::string& path, bool is_writing) {
  path_ = path;
  if (is_writing) lock();
  else if (!std::filesystem::exists(path)) throw StoreError(path, "there is no store '" + path + "'");
  const int flags = is_writing ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  if (sqlite3_open_v2(path.c_str(), &database_, flags, nullptr) != SQLITE_OK) fail("opened");
  if (!is_writing && is_cut_off()) { // opening with write access rolls back the incomplete batch
    sqlite3_close(database_);
    if (sqlite3_open_v2(path.c_str(), &database_, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK) fail("opened");
  }
  constexpr int k_patience = 10000; // longest wait for another process, ms
  sqlite3_busy_timeout(database_, k_patience);
  // Rejects unknown names, which SQLite would otherwise treat as texts, and does not execute SQL stored in the file.
  sqlite3_db_config(database_, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_exec(database_, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
}

// Returns true if the file contains no complete transaction.
bool Store::is_empty() {
  Statement s(*this, "SELECT count(*) FROM sqlite_master");
  return s.step() && s.integer(0) == 0 && pragma("application_id") == 0;
}

long Store::pragma(const char* name) {
  Statement s(*this, std::string("PRAGMA ") + name);
  return s.step() ? s.integer(0) : 0L;
}

Store::Store(const std::string& path) : Store() {
  open(path, false);
  read_identity();
  check();
}

Store::Store(const std::string& path, const StoreIdentity& identity, StoreMode mode) : Store() {
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path))
    throw StoreError(path, "'" + path + "' is no file: a store cannot be kept there");
  open(path, true);
  const bool is_there = !is_empty();
  if (mode == StoreMode::restart && is_there) {
    check_kind(); // never overwrites a file that is not a store
    for (const char* table : {"sample", "batch", "finding", "growth", "note", "setting", "curve", "history"})
      execute("DROP TABLE IF EXISTS " + quoted(table));
  }
  if (!is_there || mode == StoreMode::restart) {
    create(identity);
    return;
  }
  read_identity();
  check();
  if (identity_.version != identity.version)
    throw StoreError(path,
                     "the store '" + path + "' was made by version " + identity_.version + ", this is " + identity.version +
                         ": restart it, or choose another store",
                     {StoreMode::restart});
  if (identity_.scene != identity.scene || identity_.variables != identity.variables || identity_.numbers != identity.numbers)
    throw StoreError(path,
                     "the store '" + path +
                         "' is of another study: its models, variables, responses or limit states are not those of the "
                         "study file any more" +
                         changed_files(identity) + ". Restart it, which drops its " + std::to_string(size_) +
                         " samples, or choose another store",
                     {StoreMode::restart});
  if (identity_.study != identity.study || identity_.kind != identity.kind) {
    if (mode == StoreMode::run)
      throw StoreError(path,
                       "the study has changed since the store '" + path + "' was made" + changed_files(identity) +
                           ": go on with those of its " + std::to_string(size_) +
                           " samples that are the same, restart it, or choose another store",
                       {StoreMode::changed, StoreMode::restart});
    set("study", identity.study);
    set("kind", identity.kind);
    // Findings of an earlier version of the study are invalid until they are recomputed.
    for (const char* table : {"growth", "finding", "note"}) execute("DELETE FROM " + quoted(table));
    set("standing", "");
    set("changed", "its samples may be of the study as it was before");
    identity_ = identity;
  }
  set("files", files_text(identity));
}

// Returns the names of input files that changed since the store was written, for a message.
std::string Store::changed_files(const StoreIdentity& now) {
  std::string text;
  const std::string before = setting("files");
  for (const InputFile& file : now.files)
    if (before.find(file.sha256) == std::string::npos) text += (text.empty() ? "" : ", ") + ("'" + file.path + "'");
  return text.empty() ? "" : " (changed, or new: " + text + ")";
}

Store::~Store() {
  if (is_open_) sqlite3_exec(database_, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(database_);
  if (lock_file_ >= 0) ::close(lock_file_);
}

std::string Store::sample_columns() const {
  std::string columns = "number, status, reason, error, evaluations, cpu_seconds";
  for (const std::string& name : identity_.variables) columns += ", " + quoted("v_" + name);
  for (const std::string& name : identity_.numbers) columns += ", " + quoted("r_" + name);
  return columns;
}

void Store::create(const StoreIdentity& identity) {
  identity_ = identity;
  size_ = 0;
  execute("PRAGMA page_size = 8192");
  execute("BEGIN IMMEDIATE");
  execute("PRAGMA application_id = " + std::to_string(k_application));
  execute("PRAGMA user_version = " + std::to_string(k_layout));
  execute("CREATE TABLE setting (key TEXT PRIMARY KEY, value TEXT NOT NULL, fingerprint INTEGER) WITHOUT ROWID");
  execute("CREATE TABLE batch (last INTEGER PRIMARY KEY, fingerprint INTEGER NOT NULL)");
  std::string sql = "CREATE TABLE sample (number INTEGER PRIMARY KEY, status INTEGER NOT NULL, reason TEXT, error "
                    "REAL, evaluations REAL, cpu_seconds REAL";
  for (const std::string& name : identity.variables) sql += ", " + quoted("v_" + name) + " REAL";
  for (const std::string& name : identity.numbers) sql += ", " + quoted("r_" + name) + " REAL";
  execute(sql + ")");
  for (const char* table : {"finding", "growth"})
    execute("CREATE TABLE " + quoted(table) +
            " (place INTEGER PRIMARY KEY, method TEXT, subject TEXT, quantity TEXT, value REAL, low REAL, high REAL, "
            "samples INTEGER, status TEXT, fingerprint INTEGER)");
  if (identity.has_curves) {
    execute("CREATE TABLE curve (number INTEGER PRIMARY KEY, data BLOB NOT NULL)");
    execute("CREATE TABLE history (place INTEGER PRIMARY KEY, name TEXT, t REAL, measured REAL, fitted REAL, "
            "fingerprint INTEGER)");
  }
  execute("CREATE TABLE note (place INTEGER PRIMARY KEY, text TEXT, fingerprint INTEGER)");
  set("version", identity.version);
  set("study", identity.study);
  set("kind", identity.kind);
  set("scene", identity.scene);
  const auto joined = [](const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += name + "\n";
    return text;
  };
  set("variables", joined(identity.variables));
  set("numbers", joined(identity.numbers));
  set("files", files_text(identity));
  execute("COMMIT");
}

void Store::set(const std::string& key, const std::string& value) {
  Statement s(*this, "INSERT OR REPLACE INTO setting VALUES (?, ?, ?)");
  s.bind(1, key);
  s.bind(2, value);
  s.bind(3, fingerprint_of(key, value));
  s.once();
}

std::string Store::setting(const std::string& key) {
  Statement s(*this, "SELECT value, fingerprint FROM setting WHERE key = ?");
  s.bind(1, key);
  if (!s.step()) return "";
  std::string value = s.text(0);
  if (s.integer(1) != fingerprint_of(key, value)) damaged("what it says of '" + key + "' is not what was written");
  return value;
}

void Store::describe(const std::string& about) {
  if (setting("about") == about) return;
  begin();
  set("about", about);
  flush();
}

void Store::hold() {
  execute("BEGIN");
  read_identity(); // locks the store and reads the number of samples
}

void Store::check_kind() {
  if (pragma("application_id") != k_application) throw StoreError(path_, "'" + path_ + "' is no store of a study");
  if (const long layout = pragma("user_version"); layout != k_layout)
    throw StoreError(path_, "the store '" + path_ + "' has the layout " + std::to_string(layout) + "; this program reads layout " +
                                std::to_string(k_layout));
}

void Store::read_identity() {
  check_kind();
  const auto split = [](const std::string& text) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < text.size();) {
      const std::size_t end = text.find('\n', i);
      names.push_back(text.substr(i, end - i));
      i = end + 1;
    }
    return names;
  };
  identity_ = {setting("version"),          setting("study"),         setting("kind"), setting("scene"),
               split(setting("variables")), split(setting("numbers"))};
  Statement curves(*this, "SELECT 1 FROM sqlite_master WHERE name = 'curve'");
  identity_.has_curves = curves.step();
  Statement s(*this, "SELECT count(*), max(number) FROM sample");
  (void)s.step();
  size_ = s.integer(0);
  if (s.integer(1) != size_) damaged("samples are missing in it");
}

void Store::read(long first, long count, std::vector<StoredSample>& rows) {
  rows.resize(static_cast<std::size_t>(count));
  Statement s(*this, "SELECT " + sample_columns() + " FROM sample WHERE number >= ? AND number < ? ORDER BY number");
  s.bind(1, first);
  s.bind(2, first + count);
  for (StoredSample& row : rows) {
    if (!s.step()) damaged("samples are missing in it");
    int c = 0;
    row.number = s.integer(c++);
    row.outcome.status = status_of(s.integer(c++));
    row.outcome.reason = s.text(c++);
    row.outcome.error = s.number(c++);
    row.outcome.evaluations = s.number(c++);
    row.outcome.cpu_seconds = s.number(c++);
    row.values.resize(identity_.variables.size());
    for (double& x : row.values) x = s.number(c++);
    row.outcome.numbers.resize(identity_.numbers.size());
    for (double& x : row.outcome.numbers) x = s.number(c++);
  }
  if (identity_.has_curves) read_curves(first, rows);
}

void Store::read_curves(long first, std::vector<StoredSample>& rows) {
  Statement s(*this, "SELECT data FROM curve WHERE number >= ? AND number < ? ORDER BY number");
  s.bind(1, first);
  s.bind(2, first + static_cast<long>(rows.size()));
  for (StoredSample& row : rows) {
    if (!s.step()) damaged("histories of samples are missing in it");
    s.take(0, row.outcome.curve);
  }
}

void Store::append(const StoredSample* rows, std::size_t count) {
  const std::size_t columns = 6 + identity_.variables.size() + identity_.numbers.size();
  std::string marks = "?";
  for (std::size_t i = 1; i < columns; ++i) marks += ", ?";
  begin();
  Statement s(*this, "INSERT INTO sample (" + sample_columns() + ") VALUES (" + marks + ")");
  std::optional<Statement> curves;
  if (identity_.has_curves) curves.emplace(*this, "INSERT INTO curve VALUES (?, ?)");
  for (std::size_t i = 0; i < count; ++i) {
    const StoredSample& row = rows[i];
    int c = 1;
    s.bind(c++, row.number);
    s.bind(c++, static_cast<long>(row.outcome.status));
    if (row.outcome.reason.empty()) sqlite3_bind_null(s.statement, c++);
    else s.bind(c++, row.outcome.reason);
    s.bind(c++, row.outcome.error);
    s.bind(c++, row.outcome.evaluations);
    s.bind(c++, row.outcome.cpu_seconds);
    for (const double x : row.values) s.bind(c++, x);
    for (const double x : row.outcome.numbers) s.bind(c++, x);
    s.once();
    if (!curves) continue;
    curves->bind(1, row.number);
    curves->bind(2, row.outcome.curve);
    curves->once();
  }
  size_ += static_cast<long>(count);
  put_batch(rows, count);
  commit_if_due();
}

// Deletes the samples from `number` on. Recomputes the fingerprint of a batch that is partly deleted.
void Store::forget_from(long number) {
  if (number > size_) return;
  begin();
  const long first = begin_of_batch(number);
  std::vector<StoredSample> left;
  read(first, number - first, left);
  Statement gone(*this, "DELETE FROM batch WHERE last >= ?");
  gone.bind(1, number);
  gone.once();
  if (!left.empty()) put_batch(left.data(), left.size());
  Statement s(*this, "DELETE FROM sample WHERE number >= ?");
  s.bind(1, number);
  s.once();
  if (identity_.has_curves) execute("DELETE FROM curve WHERE number >= " + std::to_string(number));
  size_ = number - 1;
}

void Store::put(const std::string& table, long place, const Finding& f) {
  Statement s(*this, "INSERT OR REPLACE INTO " + quoted(table) + " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  s.bind(1, place);
  s.bind(2, f.method);
  s.bind(3, f.subject);
  s.bind(4, f.quantity);
  s.bind(5, f.value);
  s.bind(6, f.low);
  s.bind(7, f.high);
  s.bind(8, f.samples);
  s.bind(9, f.status);
  s.bind(10, fingerprint_of(table, place, f));
  s.once();
}

void Store::note(long place, const Finding& finding) {
  begin();
  put("growth", place, finding);
  commit_if_due();
}

void Store::set_histories(const std::vector<CurvePoint>& points) {
  begin();
  execute("DELETE FROM history");
  Statement s(*this, "INSERT INTO history VALUES (?, ?, ?, ?, ?, ?)");
  long place = 0;
  for (const CurvePoint& p : points) {
    s.bind(1, ++place);
    s.bind(2, p.history);
    s.bind(3, p.t);
    s.bind(4, p.measured);
    s.bind(5, p.fitted);
    s.bind(6, fingerprint_of(place, p));
    s.once();
  }
}

std::vector<Store::CurvePoint> Store::histories() {
  if (!identity_.has_curves) return {};
  Statement s(*this, "SELECT name, t, measured, fitted, place, fingerprint FROM history ORDER BY place");
  std::vector<CurvePoint> points;
  while (s.step()) {
    points.push_back({s.text(0), s.number(1), s.number(2), s.number(3)});
    const long place = static_cast<long>(points.size());
    if (s.integer(4) != place || s.integer(5) != fingerprint_of(place, points.back()))
      damaged("a row of a history is not what was written");
  }
  return points;
}

void Store::set_findings(const std::vector<Finding>& findings, const std::vector<std::string>& notes, const std::string& standing) {
  begin();
  execute("DELETE FROM finding");
  execute("DELETE FROM note");
  for (std::size_t i = 0; i < findings.size(); ++i) put("finding", static_cast<long>(i + 1), findings[i]);
  for (std::size_t i = 0; i < notes.size(); ++i) {
    Statement s(*this, "INSERT INTO note VALUES (?, ?, ?)");
    s.bind(1, static_cast<long>(i + 1));
    s.bind(2, notes[i]);
    s.bind(3, fingerprint_of(std::to_string(i + 1), notes[i]));
    s.once();
  }
  set("standing", standing);
  set("answer", counts_text(findings.size(), notes.size()));
  set("changed", "");
  flush();
}

std::vector<Finding> Store::all_of(const std::string& table) {
  Statement s(*this, "SELECT method, subject, quantity, value, low, high, samples, status, place, fingerprint FROM " + quoted(table) +
                         " ORDER BY place");
  std::vector<Finding> findings;
  while (s.step()) {
    findings.push_back({s.text(0), s.text(1), s.text(2), s.number(3), s.number(4), s.number(5), s.integer(6), s.text(7)});
    const long place = static_cast<long>(findings.size());
    if (s.integer(8) != place || s.integer(9) != fingerprint_of(table, place, findings.back()))
      damaged("what was found is not what was written");
  }
  return findings;
}

std::vector<Finding> Store::findings() { return all_of("finding"); }
std::vector<Finding> Store::growth() { return all_of("growth"); }

std::vector<std::string> Store::notes() {
  Statement s(*this, "SELECT text, place, fingerprint FROM note ORDER BY place");
  std::vector<std::string> notes;
  while (s.step()) {
    notes.push_back(s.text(0));
    const auto place = static_cast<long>(notes.size());
    if (s.integer(1) != place || s.integer(2) != fingerprint_of(std::to_string(place), notes.back()))
      damaged("a note is not what was written");
  }
  return notes;
}

long Store::count_of(std::size_t i) {
  Statement s(*this, "SELECT count(" + quoted("r_" + identity_.numbers[i]) + ") FROM sample");
  (void)s.step();
  return s.integer(0);
}

double Store::order_statistic(std::size_t i, long place) {
  const std::string column = quoted("r_" + identity_.numbers[i]);
  Statement s(*this, "SELECT " + column + " FROM sample WHERE " + column + " IS NOT NULL ORDER BY " + column + " LIMIT 1 OFFSET ?");
  s.bind(1, place);
  return s.step() ? s.number(0) : std::nan("");
}

std::vector<Store::Reason> Store::reasons() {
  Statement s(*this, "SELECT status, coalesce(reason, ''), count(*) AS n, min(number) FROM sample GROUP BY status, "
                     "reason ORDER BY status, n DESC, min(number)");
  std::vector<Reason> reasons;
  while (s.step()) reasons.push_back({name_of(status_of(s.integer(0))), s.text(1), s.integer(2), s.integer(3)});
  return reasons;
}

} // namespace steplap::study
