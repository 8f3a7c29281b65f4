#include "lab/stages/table.h"

#include <optional>

#include "lab/checks.h"

namespace trackbed {

const Kinds<StageInput>& stage_kinds() {
  static const Kinds<StageInput> kinds{
      "stage",
      {fill_stage(), settle_stage(), insert_stage(), load_stage(), move_stage(), servo_stage(), hold_stage(),
       scatter_stage(), replace_stage(), adjust_stage(), remove_stage(), release_stage(), repeat_stage()}};
  return kinds;
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
