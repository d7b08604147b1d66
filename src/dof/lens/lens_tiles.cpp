#include "dof/lens/lens_tiles.h"

namespace sparselens {

std::map<int, int> histogram(const LensTiles &tiles) {
    std::map<int, int> result;
    for (const int points : tiles.lens_points) ++result[points];
    return result;
}

} // namespace sparselens
