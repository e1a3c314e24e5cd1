#include "transformer/recorder/reader.h"

#include "transformer/recorder/fields.h"
#include "transformer/recorder/record_error.h"
#include "transformer/recorder/time_text.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_hole = 1.5;  // time step, in sampling intervals, above which a row is missing
constexpr double k_early = 0.3; // part of an interval by which a row must be early to compensate for a late row before it
constexpr std::size_t k_head_lines = 5000, k_head_bytes = std::size_t{1} << 20U;

// Detects clipping: sequences of equal samples at the extreme value of an axis. A smooth peak is entered and left by single steps of the
// converter, a clipped peak by a jump of at least three steps.
class FlatWatch {
public:
  void take(double value, std::size_t line) {
    if (value == value_ && run_ > 0) {
      ++run_;
      return;
    }
    const double jump = run_ > 0 ? std::abs(value - value_) : 0.0;
    if (jump > 0.0) step_ = std::min(step_, jump);
    end_run(jump);
    value_ = value;
    run_ = 1;
    entry_ = jump;
    line_ = line;
  }
  void finish(AxisFacts& facts) {
    end_run(0.0);
    facts.least = low_.value;
    facts.greatest = -high_.value;
    for (const End* end : {&low_, &high_}) { // the extreme further from rest is decisive, because a long rest would hide a peak
      const double value = end == &low_ ? end->value : -end->value;
      if (end->longest >= 3 && end->jump >= 3.0 * step_ &&
          (facts.flat_longest == 0 || std::abs(value - facts.rest) > std::abs(facts.flat_value - facts.rest)))
        facts.flat_longest = end->longest, facts.flat_line = end->line, facts.flat_value = value;
    }
  }

private:
  struct End { ///< longest sequence at an extreme; values are negated if necessary, so that the extreme is the minimum
    double value = std::numeric_limits<double>::infinity(), jump = 0.0;
    std::size_t longest = 0, line = 0;
  };
  void end_run(double exit) {
    if (run_ == 0) return;
    add(low_, value_, exit);
    add(high_, -value_, exit);
  }
  void add(End& end, double value, double exit) const {
    if (value > end.value) return;
    if (value < end.value) end = {value, 0.0, 0, line_};
    if (run_ > end.longest) end.longest = run_, end.line = line_, end.jump = std::max(entry_, exit);
  }

  End low_, high_;
  double value_ = 0.0, entry_ = 0.0, step_ = std::numeric_limits<double>::infinity();
  std::size_t run_ = 0, line_ = 0;
};

class RecordReader {
public:
  RecordReader(LineSource& source, const ReadOptions& options, SampleSink& sink) : source_(source), options_(options), sink_(sink) {}

  Recording read() {
    read_head();
    recording_.layout = find_record_layout(head_, source_.name(), options_);
    recording_.layout.encoding = source_.encoding();
    layout_ = &recording_.layout;
    prepare();
    sink_.begin(*layout_);
    for (std::size_t i = layout_->shape.first_data; i < head_.size(); ++i) {
      line_ = head_[i].number;
      is_terminated_ = i + 1 < head_.size() || head_is_terminated_;
      take_line(head_[i].text);
    }
    std::vector<HeaderLine>().swap(head_);
    for (std::string_view text; source_.next(text);) {
      line_ = source_.number();
      is_terminated_ = source_.is_terminated();
      take_line(text);
    }
    finish();
    return std::move(recording_);
  }

private:
  void read_head() {
    std::string_view text;
    for (std::size_t bytes = 0; head_.size() < k_head_lines && bytes < k_head_bytes && source_.next(text); bytes += text.size()) {
      head_.push_back({source_.number(), std::string(text)});
      head_is_terminated_ = source_.is_terminated();
    }
  }

  void prepare() {
    const TimeBase& time = layout_->time;
    const auto need = [&](std::size_t column) { needed_ = std::max(needed_, column + 1); };
    if (time.kind != TimeKind::none) need(time.column);
    if (time.kind == TimeKind::date_and_clock) need(time.clock_column);
    for (const AxisColumn& axis : layout_->axes) need(axis.column);
    const PeakColumns& peaks = layout_->peaks;
    for (const int column : {peaks.axis[0], peaks.axis[1], peaks.axis[2], peaks.magnitude, peaks.duration, peaks.velocity_change})
      if (layout_->is_peaks && column >= 0) need(static_cast<std::size_t>(column));
    uses_index_ = time.index_column && (time.kind == TimeKind::none || layout_->holds);
    if (uses_index_) need(*time.index_column);
    if (time.rate > 0.0) step_ = 1.0 / time.rate;
  }

  [[noreturn]] void fail(std::string_view field, const std::string& what) const {
    throw RecordError(layout_->file, line_, static_cast<std::size_t>(field.data() - text_.data()) + 1, what);
  }

  void take_line(std::string_view text) {
    text_ = text;
    ReadFacts& facts = recording_.facts;
    if (trimmed_blanks(text).empty()) return note_separator();
    if (is_comment(text, layout_->shape.delimiter)) {
      if (text.find_first_not_of("#*;-=_ \t") == std::string_view::npos) note_separator();
      facts.comments.note(line_);
      note_remark();
      return;
    }
    // Names have no decimal comma, so they do not form pairs.
    const bool may_name = layout_->shape.joins_pairs && split_fields(text, layout_->shape.delimiter, fields_);
    if (may_name && fields_.size() == layout_->shape.width && is_terminated_ && is_text_line()) return take_text_line();
    if (!layout_->shape.split(text, fields_)) {
      if (!is_terminated_) return cut();
      throw RecordError(
          layout_->file, line_, 1,
          "The fields of this line do not match the columns: a quote is not closed, or a decimal comma is missing. Correct the line.");
    }
    while (fields_.size() > layout_->shape.width && fields_.back().empty()) fields_.pop_back();
    if (is_text_line()) return is_terminated_ ? take_text_line() : cut();
    if (!is_terminated_ && !is_whole()) return cut();
    if (!is_terminated_) facts.unended_line = line_;
    if (!is_terminated_ && may_lack_digits()) {
      facts.is_unended_left_out = true;
      return;
    }
    note_decimals();
    if (fields_.size() > layout_->shape.most_fields)
      fail(fields_[layout_->shape.width], "This row has " + counted(fields_.size(), "field", "fields") + ", " +
                                              std::to_string(layout_->shape.width) +
                                              " were expected. If two rows ran together, part them.");
    if (fields_.size() > layout_->shape.width) {
      facts.long_rows.note(line_);
      fields_.resize(layout_->shape.width);
    }
    facts.last_comment.clear();
    if (layout_->is_peaks) return take_peaks();
    if (!take_axes()) return;
    list_words();
    take_sample();
  }

  void cut() { recording_.facts.cut_line = line_; }

  // Records a blank line, or one that contains only signs, after a row. It separates blocks if another row follows.
  void note_separator() {
    if (has_previous_ && separator_line_ == 0) separator_line_ = line_;
  }

  // Counts separators as gaps of unknown length if the file has no times, unless a separator follows every row or two.
  void judge_separators() {
    ReadFacts& facts = recording_.facts;
    const bool has_times = layout_->time.kind != TimeKind::none || uses_index_;
    if (has_times || separators_.count == 0 || 2 * separators_.count >= facts.rows) return;
    if (facts.block_gaps.count == 0) facts.block_gaps.line = separators_.line;
    facts.block_gaps.count += separators_.count;
    facts.longest_block_gap = std::numeric_limits<double>::infinity();
  }

  void note_remark() {
    recording_.facts.last_comment = shown(text_.substr(0, 80)); // last comment of the file if no row follows
    list_remark(recording_.facts.last_comment);
  }

  void list_remark(const std::string& text) {
    ReadFacts& facts = recording_.facts;
    const std::size_t rows = facts.rows + (waiting_ ? 1 : 0);
    const auto is_known = [&](Remark& each) {
      if (each.text != text) return false;
      each.rows = rows; // a comment at the end of the file counts as its end
      return true;
    };
    if (std::any_of(facts.remarks.begin(), facts.remarks.end(), is_known)) return;
    if (facts.remarks.size() >= ReadFacts::k_most_listed) facts.remarks.pop_back();
    facts.remarks.push_back({line_, rows, text});
  }

  // Lists words in a column without measured values, such as a status, that differ from those of the first row.
  void list_words() {
    const bool is_first = first_words_.empty();
    if (is_first) first_words_.resize(layout_->shape.width);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const std::string_view field = fields_[i];
      if (begins_like_number(field) || is_missing(field) || is_measured(i)) continue;
      if (is_first) first_words_[i] = field;
      else if (first_words_[i] != field) list_remark(shown(field.substr(0, 80)));
    }
  }

  // Returns true for the columns of times, sample counters and axes.
  bool is_measured(std::size_t column) const {
    const TimeBase& time = layout_->time;
    const bool is_time =
        time.kind != TimeKind::none && (column == time.column || (time.kind == TimeKind::date_and_clock && column == time.clock_column));
    return is_time || time.index_column == column ||
           std::any_of(layout_->axes.begin(), layout_->axes.end(), [&](const AxisColumn& axis) { return axis.column == column; });
  }

  std::size_t decimals(std::string_view field) const {
    const auto sign = field.find(layout_->shape.decimal);
    return sign == std::string_view::npos ? 0 : field.size() - sign - 1;
  }

  // Records the number of decimals of the last field.
  void note_decimals() {
    const std::string_view last = fields_.size() >= needed_ && needed_ > 0 ? fields_[needed_ - 1] : std::string_view();
    const bool is_first = row_fields_ == 0;
    row_fields_ = fields_.size();
    if (last.empty() || last.back() < '0' || last.back() > '9') return; // the value is missing
    const std::size_t now = decimals(last);
    is_fixed_ &= is_first || now == row_decimals_;
    row_decimals_ = now;
  }

  // Returns true if the last line, which has no line break, is complete: it has as many fields as the header or the row before, and its
  // last field is a number.
  bool is_whole() const {
    if (fields_.size() > needed_) return true; // a delimiter follows the last needed field
    if (fields_.size() < std::min(layout_->shape.width, std::max(row_fields_, needed_))) return false;
    const std::string_view last = fields_.back();
    return !last.empty() && last.back() >= '0' && last.back() <= '9' && decimals(last) >= row_decimals_;
  }

  // Returns true if the last number may have lost digits without a visible sign: an integer, or a number in a file with varying numbers of
  // decimals.
  bool may_lack_digits() const {
    if (fields_.size() > needed_) return false;
    const std::size_t digits = decimals(fields_.back());
    return digits == 0 || !is_fixed_ || row_fields_ == 0 || digits != row_decimals_;
  }

  // Returns true for a title, or for the names or units of another block of the file.
  bool is_text_line() const {
    const std::string_view first = fields_.front();
    if (begins_like_number(first) || first.empty() || looks_like_row(fields_)) return false;
    const auto is_number = [](std::string_view f) { return parse_number(f, '.') || parse_number(f, ','); };
    const bool has_number = std::any_of(fields_.begin(), fields_.end(), is_number);
    return !(fields_.size() == layout_->shape.width && (has_number || layout_->shape.width == 1));
  }

  void take_text_line() {
    const TableShape& shape = layout_->shape;
    const bool is_of_full_width = fields_.size() == shape.width && !shape.names.empty();
    const auto is_as = [&](const std::vector<std::string>& texts) {
      return std::equal(fields_.begin(), fields_.end(), texts.begin(), texts.end(),
                        [](std::string_view a, const std::string& b) { return a == b; });
    };
    if (is_of_full_width && !is_as(shape.names) && !is_as(shape.units))
      fail(fields_.front(), "This line names other columns than line " + std::to_string(shape.names_line) +
                                ". Split the file before it, and read the parts one by one.");
    recording_.facts.blocks.note(line_);
    // Full width: names and units are repeated with each block.
    if (is_of_full_width) recording_.facts.last_comment = shown(text_.substr(0, 80));
    else note_remark();
    is_new_block_ = true;
  }

  double number_in(std::string_view field) {
    TableShape& shape = recording_.layout.shape;
    if (const auto value = parse_number(field, shape.decimal)) {
      shape.has_decimals |= field.find('.') != std::string_view::npos;
      return *value;
    }
    const auto comma = field.find(',');
    if (!shape.has_decimals && shape.delimiter != ',' && comma != std::string_view::npos && parse_number(field, ',') &&
        (field.size() - comma != 4 || field.front() == '0')) {
      shape.decimal = ','; // the first number with decimals defines the decimal sign
      shape.has_decimals = true;
      return *parse_number(field, ',');
    }
    if (field.find(',') != std::string_view::npos && shape.delimiter != ',')
      fail(field, "'" + shown(field) + "' is no number with a decimal " + (shape.decimal == ',' ? "comma" : "point") +
                      ", as those before it. Correct it, or give --decimal.");
    fail(field, "'" + shown(field.substr(0, 40)) +
                    "' is not a finite number. Correct it, or leave the field empty and give --missing skip or hold.");
  }

  // Reads the accelerations of a row. Returns false if the row contains no sample.
  bool take_axes() {
    ReadFacts& facts = recording_.facts;
    std::size_t missing = 0;
    std::string_view first_missing;
    const auto count = layout_->axes.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t column = layout_->axes[i].column;
      const std::string_view field = column < fields_.size() ? fields_[column] : text_.substr(text_.size());
      is_missing_[i] = field.empty() || (!(field.back() >= '0' && field.back() <= '9') && is_missing(field));
      if (is_missing_[i] && missing++ == 0) first_missing = field;
      if (!is_missing_[i]) values_[i] = number_in(field) * layout_->axes[i].factor;
    }
    if (missing == 0) {
      if (fields_.size() < layout_->shape.width) facts.short_rows.note(line_);
      return true;
    }
    if (missing == count && has_other_value()) {
      facts.other_rows.note(line_);
      return false;
    }
    if (options_.missing == IfMissing::refuse)
      fail(first_missing,
           "There is no value for an axis here. Give --missing skip to leave such rows out, or --missing hold to keep the value before.");
    facts.missing.note(line_);
    if (options_.missing == IfMissing::skip || !has_previous_) return skip_row();
    for (std::size_t i = 0; i < count; ++i)
      if (is_missing_[i]) values_[i] = previous_[i];
    return true;
  }

  // Omits a row, which still counts for the time if times are counted by rows. Returns false.
  bool skip_row() {
    if (is_new_block_ && layout_->time.kind == TimeKind::none && !uses_index_) end_segment(), rows_in_block_ = 0, is_new_block_ = false;
    ++rows_in_block_;
    return false;
  }

  // Returns true if another sensor has a value in this row. Such a row has no acceleration.
  bool has_other_value() const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (!is_measured(i) && !is_missing(fields_[i])) return true;
    return false;
  }

  std::string_view field_at(std::size_t column, const char* what) const {
    if (column >= fields_.size())
      fail(text_.substr(text_.size()), std::string("The row ends before its ") + what + ". Correct it or take it out.");
    return fields_[column];
  }

  std::int64_t stamp_ns() {
    const TimeBase& time = layout_->time;
    const std::string_view field = field_at(time.column, "time");
    const auto stamp = parse_stamp(field, time.date_order);
    if (!stamp)
      fail(field,
           "'" + shown(field.substr(0, 40)) + "' is no date or time in the form of the rows before (" + time.text + "). Correct it.");
    if (first_stamp_ && (stamp->has_date != first_stamp_->has_date || stamp->has_zone != first_stamp_->has_zone ||
                         stamp->has_clock != first_stamp_->has_clock))
      fail(field, "'" + shown(field.substr(0, 40)) +
                      "' has another form than the first time of the file: a date, a time of day or a zone more or less. Correct it.");
    if (!first_stamp_) first_stamp_ = stamp;
    std::int64_t ns = stamp->ns;
    if (time.kind == TimeKind::date_and_clock) {
      const std::string_view clock_field = field_at(time.clock_column, "time of day");
      const auto clock = parse_stamp(clock_field, k_year_first);
      if (!clock || clock->has_date || stamp->has_clock)
        fail(clock_field, "'" + shown(clock_field.substr(0, 40)) + "' is no time of day. Correct it.");
      ns += clock->ns;
    } else if (!stamp->has_date) {
      ns += midnights_ * k_day_ns;
      if (has_origin_ && ns < last_ns_ - k_day_ns / 2) {
        ++midnights_;
        ns += k_day_ns;
        recording_.facts.midnights.note(line_);
      }
      last_ns_ = ns;
    }
    return ns;
  }

  double time_of_row() {
    const TimeBase& time = layout_->time;
    if (time.kind == TimeKind::none && !uses_index_) return static_cast<double>(rows_in_block_) * step_;
    if (time.kind == TimeKind::none) return index_ * step_;
    if (time.kind == TimeKind::number) {
      const std::string_view field = field_at(time.column, "time");
      if (is_missing(field)) fail(field, "The row has no time. Correct it or take it out.");
      const double value = number_in(field);
      if (!time.is_relative) return value * time.factor;
      if (!has_origin_) origin_ = value, has_origin_ = true;
      return (value - origin_) * time.factor;
    }
    const std::int64_t ns = stamp_ns();
    if (!has_origin_) origin_ns_ = ns, has_origin_ = true;
    return 1e-9 * static_cast<double>(ns - origin_ns_);
  }

  void take_index() {
    if (!uses_index_) return;
    const std::string_view field = field_at(*layout_->time.index_column, "number of the sample");
    const double value = number_in(field);
    if (value != std::floor(value))
      fail(field, "'" + shown(field) + "' is not the number of a sample. Correct it, or choose a column of times with --time.");
    if (!has_first_index_) first_index_ = value, has_first_index_ = true;
    index_step_ = value - first_index_ - index_;
    index_ = value - first_index_;
  }

  void take_sample() {
    ReadFacts& facts = recording_.facts;
    if (is_new_block_) rows_in_block_ = 0, has_first_index_ = false, index_ = 0.0;
    take_index();
    const double t = time_of_row();
    ++rows_in_block_;
    if (separator_line_ > 0) separators_.note(separator_line_), separator_line_ = 0;
    const std::string_view place = layout_->time.kind == TimeKind::none ? text_ : field_at(layout_->time.column, "time");
    const bool is_first = !is_in_segment_;
    if (is_new_block_ && has_previous_ && !layout_->holds) note_block_gap(t - t_);
    if (!is_first && !is_new_block_) {
      const double passed = t - t_;
      settle_hole(passed);
      if (passed == 0.0 && !take_repeated(place)) return;
      if (passed < 0.0 && !take_backward(place)) return;
      if (passed > options_.gap * step_ || (layout_->holds && passed > k_hole * step_)) take_gap(t, passed);
      else if (!layout_->holds && passed > k_hole * step_) suspect_hole(passed);
    }
    if (is_new_block_ && is_in_segment_) end_segment();
    is_new_block_ = false;
    if (!is_in_segment_) {
      sink_.begin_segment(line_);
      ++facts.segments;
      is_in_segment_ = true;
    }
    if (!has_previous_) facts.first = t;
    put(t);
  }

  // Records a gap before a new block, unless the block begins where the previous one ended. `passed`: time since then, s.
  void note_block_gap(double passed) {
    ReadFacts& facts = recording_.facts;
    if (passed > 0.0 && passed <= k_hole * step_) return;
    facts.block_gaps.note(line_);
    facts.longest_block_gap = std::max(facts.longest_block_gap, passed > 0.0 ? passed : std::numeric_limits<double>::infinity());
  }

  // Stores a suspected gap of missing rows. If the next row is early by the same amount, the clock jitters and no row is missing. `passed`:
  // time since the previous row, s.
  void suspect_hole(double passed) {
    hole_ = Hole{line_, t_, passed, static_cast<std::size_t>(std::lround(passed / step_)) - 1, previous_, values_};
  }
  void settle_hole(double passed) {
    if (!hole_) return;
    const double on_time = static_cast<double>(hole_->rows + 1) * step_;
    const bool is_jitter = hole_->length + passed < on_time + (1.0 - k_early) * step_;
    if (!is_jitter) note_hole();
    hole_.reset();
  }
  void note_hole() {
    ReadFacts& facts = recording_.facts;
    facts.holes.note(hole_->line);
    if (facts.hole_list.size() < ReadFacts::k_most_listed) facts.hole_list.push_back(*hole_);
  }

  void put(double t) {
    t_ = t;
    previous_ = values_;
    has_previous_ = true;
    if (options_.repeated != IfRepeated::last) return hand_on(t, values_, line_);
    hand_on_waiting(); // another row with this time may follow
    waiting_ = {t, values_, line_};
  }

  void hand_on_waiting() {
    if (waiting_) hand_on(waiting_->t, waiting_->a, waiting_->line);
    waiting_.reset();
  }

  void hand_on(double t, const std::array<double, 3>& a, std::size_t line) {
    ReadFacts& facts = recording_.facts;
    const std::array<double, 2> rest = options_.rest.value_or(std::array{facts.first, facts.first + 1.0});
    const bool is_at_rest = t >= rest[0] && t <= rest[1];
    for (std::size_t i = 0; i < layout_->axes.size(); ++i) {
      watches_[i].take(a[i], line);
      if (layout_->range && std::abs(a[i]) >= k_saturates * *layout_->range) facts.axes[i].beyond_range.note(line);
      if (is_at_rest) sums_[i] += a[i];
    }
    summed_ += is_at_rest;
    ++facts.rows;
    facts.last = t;
    sink_.put(t, a.data());
  }

  // Handles a row with the same time as the row before: keeps the first or the last of them, or throws. Returns false, because the row adds
  // no sample.
  bool take_repeated(std::string_view place) {
    if (options_.repeated == IfRepeated::refuse)
      fail(place, "The time '" + shown(place.substr(0, 40)) +
                      "' is that of the row before. Give --repeated first or last to keep one row of each time; if the clock is too coarse "
                      "for the rate, give --time none and --rate HZ.");
    recording_.facts.repeated.note(line_);
    if (waiting_) waiting_->a = previous_ = values_, waiting_->line = line_;
    return false;
  }

  bool take_backward(std::string_view place) {
    if (options_.backward == IfBackward::refuse)
      fail(place, "The time '" + shown(place.substr(0, 40)) +
                      "' comes before that of the row before. Give --backward split if a new part begins here, or --backward drop to leave "
                      "such rows out.");
    recording_.facts.backward.note(line_);
    if (options_.backward == IfBackward::drop) return false;
    end_segment();
    return true;
  }

  void take_gap(double t, double passed) {
    ReadFacts& facts = recording_.facts;
    if (layout_->holds && (!uses_index_ || index_step_ > 1.0)) {
      facts.held.note(line_);
      if (passed > k_hole * step_) {
        hand_on_waiting();
        const std::array<double, 3> before = previous_;
        sink_.put(t - step_, before.data());
      }
    } else if (passed > options_.gap * step_) {
      facts.gaps.note(line_);
      facts.longest_gap = std::max(facts.longest_gap, passed);
      end_segment();
    }
  }

  void end_segment() {
    if (hole_) note_hole();
    hole_.reset();
    hand_on_waiting();
    if (is_in_segment_) sink_.end_segment();
    is_in_segment_ = false;
  }

  void take_peaks() {
    const PeakColumns& columns = layout_->peaks;
    const auto value = [&](int column, double factor) {
      const auto i = static_cast<std::size_t>(column);
      if (column < 0 || i >= fields_.size() || is_missing(fields_[i])) return std::numeric_limits<double>::quiet_NaN();
      return number_in(fields_[i]) * factor;
    };
    PeakEntry entry;
    entry.line = line_;
    entry.t = time_of_row();
    for (std::size_t i = 0; i < 3; ++i) entry.axis[i] = value(columns.axis[i], columns.factor);
    entry.magnitude = value(columns.magnitude, columns.factor);
    entry.duration = value(columns.duration, columns.duration_factor);
    entry.velocity_change = value(columns.velocity_change, columns.velocity_factor);
    if (entry.duration < 0.0) fail(fields_[static_cast<std::size_t>(columns.duration)], "A shock cannot last a negative time. Correct it.");
    if (!recording_.peaks.empty() && entry.t < recording_.peaks.back().t && options_.backward == IfBackward::refuse)
      fail(layout_->time.kind == TimeKind::none ? text_ : field_at(layout_->time.column, "time"),
           "This entry is earlier than the one before. Give --backward split if entries are not in order.");
    if (recording_.facts.rows == 0) recording_.facts.first = entry.t;
    recording_.facts.last = entry.t;
    ++recording_.facts.rows;
    ++rows_in_block_;
    recording_.peaks.push_back(entry);
  }

  void finish() {
    end_segment();
    ReadFacts& facts = recording_.facts;
    facts.lines = source_.number();
    facts.rest = options_.rest;
    judge_separators();
    if (facts.rows == 0)
      throw RecordError(layout_->file, facts.lines, 1,
                        facts.cut_line > 0 || facts.is_unended_left_out
                            ? "The only row is cut: no row is left. Copy the file again from the recorder."
                            : "No row of the table holds an acceleration. Choose columns with --x, --y, --z.");
    for (std::size_t i = 0; i < layout_->axes.size(); ++i) {
      facts.axes[i].rest = summed_ > 0 ? sums_[i] / static_cast<double>(summed_) : 0.0;
      watches_[i].finish(facts.axes[i]);
    }
  }

  LineSource& source_;
  const ReadOptions& options_;
  SampleSink& sink_;
  Recording recording_;
  const RecordLayout* layout_ = nullptr;
  std::vector<HeaderLine> head_;
  bool head_is_terminated_ = true, is_terminated_ = true;
  std::string_view text_; ///< the present line
  std::vector<std::string_view> fields_;
  std::size_t line_ = 0, needed_ = 0, rows_in_block_ = 0, summed_ = 0;
  std::size_t row_fields_ = 0, row_decimals_ = 0; ///< number of fields and decimals of the last field in the previous row
  bool is_fixed_ = true;                          ///< the last fields of all rows so far have equally many decimals
  double step_ = 0.0;                             ///< sampling interval, s
  std::vector<std::string> first_words_;          ///< words of the first row, per column
  Counted separators_;                            ///< blank lines, or lines that contain only signs, between rows
  std::size_t separator_line_ = 0;                ///< line of the last separator without a row after it; 0: none
  struct Row {
    double t = 0.0;
    std::array<double, 3> a{};
    std::size_t line = 0;
  };
  std::optional<Hole> hole_;   ///< suspected gap, until the next row confirms it
  std::optional<Row> waiting_; ///< row that is held back: of several rows with the same time the last one is kept
  std::array<double, 3> values_{}, previous_{}, sums_{};
  std::array<bool, 3> is_missing_{};
  std::array<FlatWatch, 3> watches_;
  bool has_previous_ = false, is_in_segment_ = false, is_new_block_ = false, has_origin_ = false, uses_index_ = false,
       has_first_index_ = false;
  double t_ = 0.0, origin_ = 0.0, index_ = 0.0, index_step_ = 0.0, first_index_ = 0.0;
  std::int64_t origin_ns_ = 0, last_ns_ = 0, midnights_ = 0;
  std::optional<Stamp> first_stamp_;
};

} // namespace

Recording read_record(LineSource& source, const ReadOptions& options, SampleSink& sink) {
  return RecordReader(source, options, sink).read();
}

} // namespace steplap
