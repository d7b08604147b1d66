// The outermost pixels of a window.
#pragma once

#include <Imath/ImathBox.h>

namespace sparselens {

// Calls visit(x, y) once for each of these pixels.
template <typename Visit>
void for_each_border_pixel(const Imath::Box2i &box, const Visit &visit) {
    for (int x = box.min.x; x <= box.max.x; ++x) {
        visit(x, box.min.y);
        if (box.max.y > box.min.y) visit(x, box.max.y);
    }
    for (int y = box.min.y + 1; y < box.max.y; ++y) {
        visit(box.min.x, y);
        if (box.max.x > box.min.x) visit(box.max.x, y);
    }
}

} // namespace sparselens
