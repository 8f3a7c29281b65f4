// How many threads the engine uses; results do not depend on it.
#pragma once

namespace trackbed {

/// 0: all cores. Returns the number in use.
int use_threads(int threads);

}  // namespace trackbed
