// Small machines on a driven tank, and histories to drive them by.
#pragma once

#include "tools/assess/assessment.h"

#include <string>

namespace assess_test {

/// A block of 1000 kg on the floor of a tank, friction `mu` at its foot; `more` is added to the text.
[[nodiscard]] std::string block_text(double mu, const std::string& more = "");
/// A model of that text, driven.
[[nodiscard]] steplap::assess::DrivenModel driven(const std::string& text);
/// Triangles along x one after the other, peaks in m/s², each `duration` s long with `quiet` s after it, samples every `step` s.
[[nodiscard]] steplap::assess::DriveHistory triangles(const std::vector<double>& peaks, double duration, double quiet, double step = 1e-3);
/// The final value of a channel after a driven run.
[[nodiscard]] double final_value(const steplap::assess::DrivenModel& model, const steplap::assess::DriveHistory& history,
                                 const std::string& channel);
/// A folder that is empty, and gone at the end.
struct Folder {
  Folder();
  Folder(const Folder&) = delete;
  ~Folder();
  [[nodiscard]] std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path;
};
void write(const std::string& file, const std::string& text);
/// A record of times and x, y, z in g, at `rate`: what `x` (m/s²) gives at t, gravity along z.
[[nodiscard]] std::string record_csv(double rate, double duration, const std::function<double(double)>& x);

} // namespace assess_test
