// Table of functions that kinds of elements and tables provide for runs: drawings, checks of the scene, assessments. The folders that
// define the kinds fill the table (elements/views/element_views.h, transformer/program.h), so that this folder depends on no kind.
#pragma once

#include "mbd/model/model.h"
#include "mbd/run/finding.h"
#include "mbd/trust/joint_assessment.h"

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace steplap {

class Sketch;
struct ContactAtStart;
struct LoadedModel;
struct StartScene;

/// Two overlapping sheets of a joint, to be drawn. All points are in one frame, m.
struct DrawnSheets {
  std::string joint, limb, active_part; ///< names of the joint and of the bodies that carry the sheets
  bool is_in_ground = false;            ///< true: points are in ground axes in the reference pose; false: in the frame of the sheet's body
  double count = 1.0;                   ///< number of equal pairs of sheets
  std::vector<Vec2> yoke, limb_sheet;   ///< outlines of the two sheets
  std::vector<Vec2> yoke_holes, limb_holes;                  ///< centres of round holes
  std::vector<Vec2> hole;                                    ///< outline of a round hole about its centre
  std::vector<std::vector<Vec2>> yoke_cutouts, limb_cutouts; ///< cutouts of the two sheets, closed polygons
};

/// Functions of one kind of element. Entries may be null.
struct ElementView {
  void (*draw)(Sketch& sketch) = nullptr; ///< draws the element; null: a diamond at each marker, with a dotted line between them
  /// Returns the markers, in order, between which the element exerts forces along the connecting lines. Empty or null: the element also
  /// exerts other forces.
  std::vector<std::string> (*pulls_between)(const Element& element) = nullptr;
  /// Returns the assessment of a joint that is held by friction, after a run.
  JointAssessment (*assess)(const Element& element, const Model& model, const RunResult& result) = nullptr;
  /// Adds findings on a contact at the start of a run (start_scene.h).
  void (*check_contact)(StartScene& scene, const ContactAtStart& contact) = nullptr;
  /// Adds findings on an element in the given poses, for a run that begins with them.
  void (*check_poses)(StartScene& scene, const Element& element) = nullptr;
  /// Returns the sheets that the element presses on each other; nothing if the element's joint does not exist.
  std::optional<DrawnSheets> (*sheets)(const Element& element, const Model& model) = nullptr;
};

/// Functions of all kinds. Functions in a list are called in order.
struct KindViews {
  /// Closed polygons.
  using Openings = std::vector<std::vector<Vec2>>;

  std::unordered_map<const ElementKind*, ElementView> elements; ///< kinds without an entry have no functions
  /// Returns the drawing of a table as SVG, for tables that have a drawing of their own.
  std::unordered_map<const TableKind*, std::string (*)(const Element& table, const Model& model)> sheets;
  /// Return openings of a body that are inside its outline: closed polygons in the body's axes about its centre of gravity, m.
  std::vector<Openings (*)(const Body& body, const Model& model)> openings;
  /// Return physical effects that the model cannot contain, one sentence each.
  std::vector<std::vector<std::string> (*)(const Model& model)> left_out;
  /// Return implausible values of a model.
  std::vector<std::vector<Finding> (*)(const Model& model)> value_checks;
  /// Return contradictions within the scene.
  std::vector<std::vector<Finding> (*)(const LoadedModel& loaded)> scene_checks;
  /// Return contradictions that affect a run only if assembly moved bodies from their given poses.
  std::vector<std::vector<Finding> (*)(const LoadedModel& loaded)> assembly_checks;

  /// Returns the functions of a kind; all null if it has no entry.
  [[nodiscard]] ElementView of(const ElementKind& kind) const {
    const auto found = elements.find(&kind);
    return found == elements.end() ? ElementView{} : found->second;
  }
};

/// The kinds that a model file may use, with their functions for runs.
struct RunCatalogue : Catalogue {
  std::shared_ptr<const KindViews> views = std::make_shared<const KindViews>(); ///< never null
};

} // namespace steplap
