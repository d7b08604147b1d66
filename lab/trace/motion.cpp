#include "lab/trace/motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sparselens::lab {

namespace {

Imath::V3d displacement(const std::vector<Imath::V3d> &path, double time) {
    if (path.empty()) return {0, 0, 0};
    if (path.size() == 1) return path[0];
    const double along = time * double(path.size() - 1);
    const std::size_t piece = std::min(std::size_t(std::max(along, 0.0)), path.size() - 2);
    return path[piece] + (along - double(piece)) * (path[piece + 1] - path[piece]);
}

} // namespace

Motion displaced(Motion motion, const Imath::V3d &by) {
    if (motion.path.empty()) motion.path = {{0, 0, 0}};
    for (Imath::V3d &point : motion.path) point += by;
    return motion;
}

Placement::Placement(const Motion &motion, double time)
    : pivot_(motion.pivot), axis_(motion.axis), shift_(displacement(motion.path, time)) {
    const double angle = motion.turn * (time - 0.5);
    cosine_ = std::cos(angle), sine_ = std::sin(angle);
}

// O. Rodrigues' formula (1840). Without an angle it returns v itself, bit for bit.
Imath::V3d Placement::turned(const Imath::V3d &v, double sine) const {
    return cosine_ * v + sine * (axis_ % v) + (1 - cosine_) * (axis_ ^ v) * axis_;
}

Imath::V3d Placement::point(const Imath::V3d &at_rest) const {
    return turned(at_rest - pivot_, sine_) + pivot_ + shift_;
}

Imath::V3d Placement::point_at_rest(const Imath::V3d &point) const {
    return turned(point - shift_ - pivot_, -sine_) + pivot_;
}

} // namespace sparselens::lab
