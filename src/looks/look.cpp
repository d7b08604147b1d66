#include "looks/look.h"

#include "base/error.h"

#include <fmt/format.h>

namespace sparselens {

double focal_length_for(const char *look, const LookContext &context) {
    if (context.focal_length_mm) return *context.focal_length_mm;
    throw UsageError(fmt::format("`{}` needs the focal length: give `focal_length`", look));
}

} // namespace sparselens
