// Converts an entry of a part's file into an entry of the model: with the names of the model, and at the position of the part.
#pragma once

#include "mbd/io/part_frame.h"
#include "mbd/io/parts.h"

#include <memory>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

/// Name prefix and position of one part; the default values are those of the model itself.
struct PartPlacement {
  std::string prefix;                ///< prefix of its names: "wagon 2."; "" for the model
  PartFrame frame;                   ///< its coordinate frame
  const std::string* file = nullptr; ///< name of its file
};

/// Returns a formula from a part's file with the prefix added to all names in it, except names for which `stays` returns true.
[[nodiscard]] std::string with_prefixed_names(const std::string& formula, const std::string& prefix,
                                              bool (*stays)(const std::string& name) = nullptr);
/// Adds the prefix to all names in the formulas of a node.
void prefix_formulas(Node& node, const std::string& prefix);

class PartEntries {
public:
  PartEntries(const Catalogue& catalogue, std::vector<Diagnostic>& problems);

  /// Returns true if the file of a part may contain [[array]] entries.
  [[nodiscard]] bool are_known(const std::string& array) const;
  [[nodiscard]] bool are_model_only(const std::string& array) const;
  /// Returns all names of arrays for which are_known() is true.
  [[nodiscard]] std::vector<std::string> arrays() const;

  /// Records which bodies are placed by joints of this file. The part does not place these bodies, unless they have a pose of their own.
  /// Must be called for a file before any entry of it, or of its parts, is converted.
  void note_placing_joints(const Node& root, const PartPlacement& part);
  /// Converts one entry of [[array]] in the file `root` into an entry of the model. `is_whole`: values that the entry does not give, but
  /// that follow from the position of the part, are added. If false, the entry changes another one, and only its own keys are converted.
  [[nodiscard]] Node made(const std::string& array, const Node& entry, const Node& root, const PartPlacement& part, bool is_whole = true);

private:
  struct KindFacts;
  [[nodiscard]] static std::shared_ptr<const KindFacts> facts_of(const FieldTable& fields, std::shared_ptr<Element> made);
  using Kinds = std::unordered_map<std::string, std::shared_ptr<const KindFacts>>;

  [[nodiscard]] const KindFacts* kind_of(const Kinds& kinds, const Node& entry) const;
  [[nodiscard]] bool is_placed_by_joint(const Node& body, const Node& root, const PartPlacement& part) const;
  void put_body(Node& body, const Node& root, const PartPlacement& part, bool is_whole) const;
  void put_marker(Node& marker, const PartPlacement& part, bool is_whole = true) const;
  void put_reference(Node& node, const PartPlacement& part) const;
  void put_fields(Node& entry, const KindFacts& facts, const PartPlacement& part, bool is_whole);
  void put_on_ground(Node& entry, const KindFacts& facts, const PartPlacement& part, bool is_whole);
  void put_field(Node& child, const Field& field, const KindFacts& facts, bool is_in_ground, const std::string& subject,
                 const PartPlacement& part);
  void put_presentation(const std::string& array, Node& entry, const PartPlacement& part, bool is_whole) const;

  std::vector<Diagnostic>& problems_;
  Kinds elements_, signals_, tables_;
  std::vector<std::string> model_only_;
  std::unordered_set<std::string> placed_; ///< bodies and markers of joints that place bodies, by their names in the model
};

} // namespace steplap
