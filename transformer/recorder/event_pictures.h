// Draws the largest events of a record as SVG: waveforms and shock response spectra side by side.
#pragma once

#include "transformer/recorder/events.h"
#include "transformer/recorder/shock_spectrum.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// Collects the eight largest events of a record.
class EventPictures {
public:
  /// Adds an event. `spectra` has one entry for each axis.
  void add(const ShockEvent& event, const Window& window, const std::vector<std::vector<ShockPoint>>& spectra);
  /// Returns an SVG image; "" if there are no events. `bandwidth`: highest frequency of the signal, Hz.
  [[nodiscard]] std::string svg(const RecordLayout& layout, double bandwidth) const;

private:
  struct Drawn {
    ShockEvent event;
    std::vector<double> times;                 ///< times from the begin of the window, s
    std::array<std::vector<double>, 3> values; ///< filtered signal of each axis, m/s²
    std::vector<std::vector<ShockPoint>> spectra;
  };
  std::vector<Drawn> drawn_; ///< events, largest first
};

} // namespace steplap
