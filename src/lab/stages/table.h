// The rows of the stages, each defined in the file of its name.
#pragma once

#include "lab/stage.h"

namespace trackbed {

Kind<StageInput> fill_stage();
Kind<StageInput> settle_stage();
Kind<StageInput> insert_stage();
Kind<StageInput> load_stage();
Kind<StageInput> move_stage();
Kind<StageInput> servo_stage();
Kind<StageInput> hold_stage();
Kind<StageInput> scatter_stage();
Kind<StageInput> replace_stage();
Kind<StageInput> adjust_stage();
Kind<StageInput> remove_stage();
Kind<StageInput> release_stage();
Kind<StageInput> repeat_stage();

}  // namespace trackbed
