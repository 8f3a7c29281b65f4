#include "lab/stages/table.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/checks.h"

namespace trackbed {
namespace {

/// Notes what a declaration gives.
class Givens : public Fields {
 public:
  explicit Givens(std::string here) : here_(std::move(here)) {}
  std::vector<Foreseen> all;
  void check(bool, std::string_view, std::string_view, std::string_view) override {}
  std::string here() const override { return here_; }

 protected:
  std::optional<Value> visit(const Field&, const std::optional<Value>&) override { return std::nullopt; }
  void visit(const Field&, Elements&) override {}
  void visit_result(std::string_view name, Dimension dimension, std::string_view, bool does) override {
    if (does) all.push_back({std::string(name), dimension});
  }

 private:
  std::string here_;
};

}  // namespace

const Kinds<StageInput>& stage_kinds() {
  static const Kinds<StageInput> kinds{
      "stage",
      {fill_stage(), settle_stage(), insert_stage(), load_stage(), move_stage(), servo_stage(), hold_stage(),
       scatter_stage(), replace_stage(), adjust_stage(), remove_stage(), release_stage(), repeat_stage()}};
  return kinds;
}

std::vector<Foreseen> foreseen_results(const OneOf<StageInput>& stage) {
  Givens givens(stage.input->here);
  stage_kinds().find(stage.kind)->declare_input(givens, *stage.input);
  return std::move(givens.all);
}

void declare_common(Fields& f, StageInput& in) {
  in.here = f.here();
  std::optional<std::string> name;
  if (!in.name.empty()) name = in.name;
  f.text("name", name, "name of the stage in the results; by default its kind");
  f.check(!name || is_plain_name(*name), "name", "this cannot be the name of a stage", plain_name_hint);
  in.name = name.value_or("");
}

void declare_stages(Fields& f, std::vector<OneOf<StageInput>>& stages, std::string_view meaning) {
  f.sequence("stages", stages, stage_kinds(), meaning);
  for (const OneOf<StageInput>& stage : stages)
    if (stage.input->name.empty()) stage.input->name = stage.kind;
}

}  // namespace trackbed
