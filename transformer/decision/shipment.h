// Papers of a transport: a TOML file of the user with entries that are printed on the sheet to be signed. All entries are optional.
//
//   transformer = "serial number"  departure = "2016-01-04 10:00"  arrival = "2016-01-06 18:00"
//   [[recorder]]
//   serial = "…"  record = "shock.csv"  calibrated = "…"  range = "16 g"  filter = "…"  place = "lid, above limb 2"
//   [[handover]]
//   place = "…"  time = "…"
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// A recorder that travelled with the machine. All values are printed as given; `range` is also that of the records, if it is a number.
struct ShippedRecorder {
  std::string serial, record, calibrated, range, filter, place;
};

/// A change of the carrier.
struct Handover {
  std::string place, time;
};

/// The papers of a transport. Empty entries are not stated.
struct Shipment {
  std::string file;
  std::string transformer; ///< serial number of the transformer
  std::string departure, arrival;
  std::vector<ShippedRecorder> recorders;
  std::vector<Handover> handovers;
};

/// Reads a file. Throws ModelError with all errors, FileError if there is no such file.
[[nodiscard]] Shipment read_shipment(const std::string& file);
/// As read_shipment(), for a text in memory.
[[nodiscard]] Shipment parse_shipment(const std::string& text, const std::string& file_name);

} // namespace steplap::assess
