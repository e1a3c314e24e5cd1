#include "transformer/decision/shipment.h"

#include "mbd/io/document.h"
#include "mbd/io/read_input.h"
#include "transformer/decision/checked_table.h"

namespace steplap::assess {

namespace {

FieldTable header_fields() {
  FieldTable t;
  t.add("transformer", &Shipment::transformer).doc("its serial number");
  t.add("departure", &Shipment::departure).doc("date and time at which the journey began");
  t.add("arrival", &Shipment::arrival).doc("date and time at which it ended");
  return t;
}

FieldTable recorder_fields() {
  using T = ShippedRecorder;
  FieldTable t;
  t.add("serial", &T::serial).required().doc("its serial number");
  t.add("record", &T::record).doc("file that it wrote");
  t.add("calibrated", &T::calibrated).doc("date of the calibration");
  t.add("range", &T::range).doc("how far its sensor reads");
  t.add("filter", &T::filter).doc("filter before it stores");
  t.add("place", &T::place).doc("where it was mounted");
  return t;
}

FieldTable handover_fields() {
  FieldTable t;
  t.add("place", &Handover::place).required().doc("where the carrier changed");
  t.add("time", &Handover::time).required().doc("when");
  return t;
}

// Reads all tables [[name]] of a document and appends them to `all`.
template <class T>
void read_array(const Document& document, const std::string& name, const FieldTable& fields, std::vector<T>& all,
                std::vector<Diagnostic>& problems) {
  const Node* const array = document.root.find(name);
  if (!array) return;
  if (!array->is_array_of_tables()) {
    problems.push_back({array->where_key(), "give each " + name + " as a table [[" + name + "]]"});
    return;
  }
  for (const Node& entry : array->children) {
    TableReading reading;
    reading.subject = "[[" + name + "]]";
    read_checked_table(entry, fields, &all.emplace_back(), reading, problems);
  }
}

} // namespace

Shipment parse_shipment(const std::string& text, const std::string& file_name) {
  Document document = parse_document(text, file_name);
  refuse_control_characters(document);
  std::vector<Diagnostic> problems = document.problems;
  Shipment shipment;
  shipment.file = file_name;
  TableReading reading;
  reading.subject = "the shipment";
  reading.known_keys = {"recorder", "handover"};
  read_checked_table(document.root, header_fields(), &shipment, reading, problems);
  read_array(document, "recorder", recorder_fields(), shipment.recorders, problems);
  read_array(document, "handover", handover_fields(), shipment.handovers, problems);
  if (!problems.empty()) throw ModelError(std::move(problems));
  return shipment;
}

Shipment read_shipment(const std::string& file) {
  return parse_shipment(read_input(file, {shown_input(file), 0, 0}, "the shipment "), shown_input(file));
}

} // namespace steplap::assess
