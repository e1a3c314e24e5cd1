// The greatest events of a record, drawn: waveforms and shock response spectra side by side.
#pragma once

#include "transformer/recorder/events.h"
#include "transformer/recorder/shock_spectrum.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// Keeps what is drawn of the eight greatest events, whatever their number.
class EventPictures {
public:
  /// `spectra`: one for each axis.
  void add(const ShockEvent& event, const Window& window, const std::vector<std::vector<ShockPoint>>& spectra);
  /// An SVG picture; "" without an event. `bandwidth` of the signal, Hz.
  [[nodiscard]] std::string svg(const RecordLayout& layout, double bandwidth) const;

private:
  struct Drawn {
    ShockEvent event;
    std::vector<double> times;                 ///< s from the begin of the window
    std::array<std::vector<double>, 3> values; ///< m/s²
    std::vector<std::vector<ShockPoint>> spectra;
  };
  std::vector<Drawn> drawn_; ///< the greatest first
};

} // namespace steplap
