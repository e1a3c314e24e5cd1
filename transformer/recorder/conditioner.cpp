#include "transformer/recorder/conditioner.h"

#include "transformer/recorder/record_error.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr std::size_t k_block = 65536;
constexpr double k_on_grid = 1e-6; // tolerance of grid times, relative to a step, for times with six digits after the first time step

} // namespace

void Conditioner::begin(const RecordLayout& layout) {
  axes_ = layout.axes.size();
  rate_ = conditioning_.rate.value_or(layout.time.rate);
  if (conditioning_.frequency_class) {
    if (!ChannelFilter::is_possible(*conditioning_.frequency_class, rate_))
      throw RecordError(layout.file, 0, 0,
                        "CFC " + rounded_text(*conditioning_.frequency_class) +
                            " needs a rate of ten times that at least, and the record has " + rounded_text(rate_) +
                            " Hz. Give a class of " + rounded_text(std::floor(rate_ / 10.0)) + " or less with --cfc.");
    filter_.emplace(*conditioning_.frequency_class, rate_);
    margin_ = static_cast<std::size_t>(filter_->settling());
  }
  if (conditioning_.high_pass) set_high_pass(layout);
  sink_.begin(layout, rate_);
}

void Conditioner::set_high_pass(const RecordLayout& layout) {
  // The gain of the high-pass is 1/√2 at r⁴ = 1/(√2 − 1). The low-pass is specified by its class: f0 = 2.0775 CFC.
  const double half = *conditioning_.high_pass / std::sqrt(std::sqrt(1.0 / (std::numbers::sqrt2 - 1.0))),
               frequency_class = half / ChannelFilter::k_ratio;
  // Lowest high-pass frequency relative to the sampling rate; the memory of the filter is inversely proportional to this frequency.
  constexpr double k_slowest = 1e-5;
  if (!(*conditioning_.high_pass >= k_slowest * rate_))
    throw RecordError(layout.file, 0, 0,
                      "A high-pass of " + rounded_text(*conditioning_.high_pass) + " Hz is too low for a record of " + rounded_text(rate_) +
                          " Hz. Give " + rounded_text(k_slowest * rate_) + " Hz or more.");
  if (!ChannelFilter::is_possible(frequency_class, rate_))
    throw RecordError(layout.file, 0, 0,
                      "A high-pass of " + rounded_text(*conditioning_.high_pass) + " Hz would leave nothing of a record of " +
                          rounded_text(rate_) + " Hz. Give less.");
  low_.emplace(frequency_class, rate_);
  margin_ += static_cast<std::size_t>(low_->settling());
}

void Conditioner::begin_segment(std::size_t line) {
  ++segment_;
  rows_.clear();
  times_.clear();
  for (auto* columns : {&plain_, &filtered_})
    for (auto& column : *columns) column.clear();
  next_ = lead_ = 0;
  before_.reset();
  now_ = {};
  sink_.begin_segment(line);
}

void Conditioner::put(double t, const double* a) {
  Row row{t, {}};
  for (std::size_t i = 0; i < axes_; ++i) row.a[i] = a[i] - conditioning_.offset[i];
  if (segment_ <= conditioning_.segment_offsets.size())
    for (std::size_t i = 0; i < axes_; ++i) row.a[i] -= conditioning_.segment_offsets[segment_ - 1][i];
  if (rows_.empty() && next_ == 0) start_ = t;
  rows_.push_back(row);
  if (rows_.size() == 4) fill(false);
}

// Returns the slope of the monotone cubic at row i: a weighted harmonic mean of the adjacent secant slopes, 0 if they differ in sign; at an
// end the secant slope.
double Conditioner::slope(std::size_t i, std::size_t axis) const {
  const auto secant = [&](std::size_t k) { return (rows_[k + 1].a[axis] - rows_[k].a[axis]) / (rows_[k + 1].t - rows_[k].t); };
  if (i == 0) return secant(0);
  if (i + 1 == rows_.size()) return secant(i - 1);
  const double left = secant(i - 1), right = secant(i);
  if (left * right <= 0.0) return 0.0;
  const double h0 = rows_[i].t - rows_[i - 1].t, h1 = rows_[i + 1].t - rows_[i].t, w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / left + w1 / right);
}

// Interpolates samples on the time grid up to the third of four rows; at the end of a segment up to its end.
void Conditioner::fill(bool is_end) {
  if (rows_.empty()) return;
  const double step = 1.0 / rate_;
  const std::size_t last = is_end ? rows_.size() - 1 : rows_.size() - 2;
  for (std::size_t i = 0; i < rows_.size();) {
    const double t = start_ + static_cast<double>(next_) * step;
    if (t > rows_[last].t + k_on_grid * step) break;
    while (i + 1 < rows_.size() && rows_[i + 1].t <= t + k_on_grid * step) ++i;
    const Row& a = rows_[i];
    if (std::abs(t - a.t) <= k_on_grid * step || i + 1 == rows_.size()) {
      add(a.t, a.a);
    } else {
      const Row& b = rows_[i + 1];
      const double h = b.t - a.t, s = (t - a.t) / h;
      std::array<double, 3> value{};
      for (std::size_t k = 0; k < axes_; ++k) {
        const double d0 = slope(i, k) * h, d1 = slope(i + 1, k) * h, rise = b.a[k] - a.a[k];
        value[k] = a.a[k] + s * (d0 + s * (3.0 * rise - 2.0 * d0 - d1 + s * (d0 + d1 - 2.0 * rise)));
      }
      add(t, value);
      ++interpolated_;
    }
    ++next_;
  }
  if (!is_end) rows_.erase(rows_.begin());
}

void Conditioner::add(double t, const std::array<double, 3>& a) {
  times_.push_back(t);
  for (std::size_t i = 0; i < axes_; ++i) plain_[i].push_back(a[i]);
  if (times_.size() >= lead_ + std::max(k_block, margin_) + margin_) flush(false);
}

// Passes on all samples for which the filter has settled. Keeps the samples before and after that the filter still needs.
void Conditioner::flush(bool is_end) {
  const std::size_t size = times_.size(), end = is_end ? size : size - margin_;
  std::array<std::vector<double>, 3> without_drift;
  for (std::size_t i = 0; i < axes_ && low_; ++i) {
    without_drift[i] = plain_[i];
    low_->apply(without_drift[i]);
    for (std::size_t k = 0; k < size; ++k) without_drift[i][k] = plain_[i][k] - without_drift[i][k];
  }
  const auto& before = low_ ? without_drift : plain_;
  for (std::size_t i = 0; i < axes_ && filter_; ++i) {
    filtered_[i] = before[i];
    filter_->apply(filtered_[i]);
  }
  std::array<double, 3> plain{}, filtered{};
  for (std::size_t k = lead_; k < end; ++k) {
    for (std::size_t i = 0; i < axes_; ++i) {
      plain[i] = before[i][k];
      filtered[i] = filter_ ? filtered_[i][k] : plain[i];
    }
    integrate(times_[k], filtered.data());
    sink_.put(times_[k], plain.data(), filtered.data());
  }
  const std::size_t kept = std::min(end, margin_), from = end - kept;
  lead_ = kept;
  times_.erase(times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(from));
  for (std::size_t i = 0; i < axes_; ++i) plain_[i].erase(plain_[i].begin(), plain_[i].begin() + static_cast<std::ptrdiff_t>(from));
}

void Conditioner::integrate(double t, const double* a) {
  Row row{t, {}};
  std::copy(a, a + axes_, row.a.begin());
  if (!before_) began_ = t;
  for (std::size_t i = 0; i < axes_ && before_; ++i) {
    const double h = t - before_->t, v = now_.velocity[i];
    now_.velocity[i] += 0.5 * h * (before_->a[i] + a[i]);
    now_.displacement[i] += h * v + h * h * (before_->a[i] / 3.0 + a[i] / 6.0);
  }
  now_.duration = t - began_;
  before_ = row;
}

void Conditioner::end_segment() {
  fill(true);
  flush(true);
  if (now_.duration >= drift_.duration) drift_ = now_;
  means_.emplace_back();
  for (std::size_t i = 0; i < axes_ && now_.duration > 0.0; ++i) means_.back()[i] = now_.velocity[i] / now_.duration;
  sink_.end_segment();
}

} // namespace steplap
