// A stage of an experiment: it sets targets and says when it is done; the engine moves the stones.
//
// To add one: src/lab/stages/<name>.cpp with an input struct (a child of StageInput), its `declare`, which
// also says what the stage finds (Fields::gives), a child of Stage and its row; and the row's name in
// stages/table.cpp.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/archive.h"
#include "base/units.h"
#include "io/csv.h"
#include "io/progress.h"
#include "io/schema.h"
#include "lab/simulation.h"

namespace trackbed {

/// A number found by a stage or a measure.
struct Result {
  std::string name;
  double value = 0;  // SI
  Dimension dimension = Dimension::none;
  template <class A>
  void archive(A& a) {
    a(name, value, dimension);
  }
};

/// Rows that a stage leaves besides its results, in stages/STAGE-NAME.csv.
struct ResultTable {
  std::string name;
  std::vector<Column> columns;            // of numbers
  std::vector<std::vector<double>> rows;  // SI; as many values as columns
  template <class A>
  void archive(A& a) {
    a(name, columns, rows);
  }
};

class Document;
class Presence;
class Stage;
struct CaseInput;

/// What every stage has.
struct StageInput {
  std::string name;  // default: its kind
  std::string here;  // where it stands in the file, for errors found later
  virtual ~StageInput() = default;
  /// Refuses, with Document::fail, what is wrong and can be known before the run; the stage relies on it.
  virtual void check(const Document&, const CaseInput&, const Simulation&) const {}
  /// Takes note of what it puts in place or takes away, and refuses to act on what is not there then.
  virtual void follow(const Document&, Presence&) const {}
  virtual std::unique_ptr<Stage> make(const CaseInput& experiment) const = 0;
};

/// Declares the keys that every stage has; each stage's `declare` calls it first.
void declare_common(Fields& f, StageInput& in);

class Stage {
 public:
  virtual ~Stage() = default;

  /// Called once before the first step; may add, remove and place stones, and change the model's conditions
  /// until its end.
  virtual void open(Simulation& sim) = 0;
  /// Called before each step: sets the targets of drives.
  virtual void control(Simulation&) {}
  virtual bool finished(const Simulation& sim) = 0;
  /// Called once after the last step; returns what it found. The conditions are brought back after it.
  virtual std::vector<Result> close(Simulation&) { return {}; }
  /// The table it leaves, if any; looked at after close. To be archived with the rest.
  virtual const ResultTable* table() const { return nullptr; }
  /// Simulated time this stage will take from now on, for the progress line [s]; 0: not known.
  virtual double remaining(const Simulation&) const { return 0; }
  /// What it waits for, for the progress line.
  virtual Awaited awaited(const Simulation&) const { return {}; }
  /// All that changes between open and close, for a run that is taken up again.
  virtual void archive(Archive&) = 0;
};

/// All stages that a case may name.
const Kinds<StageInput>& stage_kinds();

/// What a stage will find, as its `declare` says: a result's name, in which NUMBER stands for one, and
/// dimension.
struct Foreseen {
  std::string name;
  Dimension dimension = Dimension::none;
};
std::vector<Foreseen> foreseen_results(const OneOf<StageInput>& stage);

/// Declares a list of stages under the key `stages`; each has its kind for a name where it has no other.
void declare_stages(Fields& f, std::vector<OneOf<StageInput>>& stages, std::string_view meaning);

}  // namespace trackbed
