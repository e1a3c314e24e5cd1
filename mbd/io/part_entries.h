// An entry of a part's file as the model has it: its names are the model's, and it stands where the part stands.
#pragma once

#include "mbd/io/part_frame.h"
#include "mbd/io/parts.h"

#include <memory>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

/// One part, or the model itself.
struct PartPlacement {
  std::string prefix;                ///< of its names: "wagon 2."; "" of the model
  PartFrame frame;                   ///< where it stands
  const std::string* file = nullptr; ///< its file
};

/// The formula with the names of a part's entries as the model has them; those for which `stays` is true stay as they are.
[[nodiscard]] std::string with_prefixed_names(const std::string& formula, const std::string& prefix,
                                              bool (*stays)(const std::string& name) = nullptr);
/// The same for all formulas in a node.
void prefix_formulas(Node& node, const std::string& prefix);

class PartEntries {
public:
  PartEntries(const Catalogue& catalogue, std::vector<Diagnostic>& problems);

  /// Are there tables of that name, kernel's or not, whose entries a part may bring?
  [[nodiscard]] bool are_known(const std::string& array) const;
  [[nodiscard]] bool are_of_model_alone(const std::string& array) const;
  /// All names for which are_known() holds.
  [[nodiscard]] std::vector<std::string> arrays() const;

  /// Notes what joints of the file join that say where one of their bodies is against the other: a body without a pose of its own
  /// gets it from there, and not from its part. To be called for a file before anything in it or in its parts is made.
  void note_placing_joints(const Node& root, const PartPlacement& part);
  /// The entry of [[array]] in the file `root` as the model has it. `is_whole`: what the place of the part gives it besides its own keys
  /// is added; else it is to be laid over another, of which it changes what it says.
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
  void put_field(Node& child, const Field& field, const KindFacts& facts, bool is_in_ground, const std::string& subject,
                 const PartPlacement& part);
  void put_presentation(const std::string& array, Node& entry, const PartPlacement& part, bool is_whole) const;

  std::vector<Diagnostic>& problems_;
  Kinds elements_, signals_, tables_;
  std::vector<std::string> of_model_alone_;
  std::unordered_set<std::string> placed_; ///< bodies and markers, by the model's names, that such joints join
};

} // namespace steplap
