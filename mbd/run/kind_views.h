// Table of functions with which kinds of elements and tables answer a run: drawings, checks of the scene, assessments. The folders that
// define the kinds fill it (elements/views/element_views.h, transformer/program.h), so that this folder names no kind.
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
  std::string joint, limb, active_part;     ///< names of the joint and of the bodies that carry the sheets
  bool is_in_ground = false;                ///< points are in ground axes in the reference pose; otherwise in the frame of the sheet's body
  double count = 1.0;                       ///< number of such pairs
  std::vector<Vec2> yoke, limb_sheet;       ///< outlines
  std::vector<Vec2> yoke_holes, limb_holes; ///< centres of round holes
  std::vector<Vec2> hole;                   ///< outline of a round hole about its centre
  std::vector<std::vector<Vec2>> yoke_cutouts, limb_cutouts; ///< outlines
};

/// Answers of one kind of element. Entries may be null.
struct ElementView {
  void (*draw)(Sketch& sketch) = nullptr; ///< null: a diamond at each marker, with a dotted line between them
  /// Returns the markers between which the element exerts forces along the connecting lines and nothing else, in order. Empty: it exerts
  /// others. Null: others.
  std::vector<std::string> (*pulls_between)(const Element& element) = nullptr;
  /// Returns the assessment after a run, for joints that are held by friction.
  JointAssessment (*assess)(const Element& element, const Model& model, const RunResult& result) = nullptr;
  /// Adds findings on a contact at the start of a run (start_scene.h).
  void (*check_contact)(StartScene& scene, const ContactAtStart& contact) = nullptr;
  /// Adds findings on an element in the given poses, for a run that begins with them.
  void (*check_poses)(StartScene& scene, const Element& element) = nullptr;
  /// Returns the sheets that the element presses on each other; nothing if its joint does not exist.
  std::optional<DrawnSheets> (*sheets)(const Element& element, const Model& model) = nullptr;
};

/// Answers of all kinds to questions of a run. Functions of a list are called in its order.
struct KindViews {
  /// Closed polygons.
  using Openings = std::vector<std::vector<Vec2>>;

  std::unordered_map<const ElementKind*, ElementView> elements; ///< kinds without an entry have no answers
  /// Returns the drawing of a table as SVG, for tables that are drawn on a sheet of their own.
  std::unordered_map<const TableKind*, std::string (*)(const Element& table, const Model& model)> sheets;
  /// Return openings of a body that its outline covers: closed polygons in the body's axes about its centre of gravity, m.
  std::vector<Openings (*)(const Body& body, const Model& model)> openings;
  /// Return effects that the model cannot contain, one sentence each.
  std::vector<std::vector<std::string> (*)(const Model& model)> left_out;
  /// Return implausible values of a model.
  std::vector<std::vector<Finding> (*)(const Model& model)> value_checks;
  /// Return contradictions within the scene.
  std::vector<std::vector<Finding> (*)(const LoadedModel& loaded)> scene_checks;
  /// Return contradictions that affect a run only if assembly moved the bodies.
  std::vector<std::vector<Finding> (*)(const LoadedModel& loaded)> assembly_checks;

  /// Returns the answers of a kind; those without any answer if it has no entry.
  [[nodiscard]] ElementView of(const ElementKind& kind) const {
    const auto found = elements.find(&kind);
    return found == elements.end() ? ElementView{} : found->second;
  }
};

/// The kinds that a model file may use, with their answers to questions of a run.
struct RunCatalogue : Catalogue {
  std::shared_ptr<const KindViews> views = std::make_shared<const KindViews>(); ///< never null
};

} // namespace steplap
