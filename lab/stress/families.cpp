#include "lab/stress/stress_case.h"

#include <array>

namespace sparselens::lab {

std::span<const StressFamily> stress_families() {
    static const std::array families{
        StressFamily{"depth", depth_stress()}, StressFamily{"blur", blur_stress()},
        StressFamily{"steep", steep_stress()}, StressFamily{"light", light_stress()},
        StressFamily{"lamps", lamp_stress()},  StressFamily{"shape", shape_stress()},
        StressFamily{"looks", look_stress()},  StressFamily{"views", view_stress()},
        StressFamily{"scale", scale_stress()}, StressFamily{"cost", cost_stress()}};
    return families;
}

} // namespace sparselens::lab
