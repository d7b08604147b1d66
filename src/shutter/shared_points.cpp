#include "shutter/shared_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace sparselens {

namespace {

// Points farther back in a share's order lie elsewhere on the lens, because the spiral has gone on.
constexpr std::size_t most_compared = 128;
// The square of a pixel, in units of the square of the lens's radius.
constexpr double pixel_square = 0.25;

double around(double difference) { return difference - std::round(difference); }

// How close two points are, on the lens and in the pixel, whose borders meet.
double closeness(const LensSample &a, const LensSample &b) {
    const double x = double(a.x - b.x), y = double(a.y - b.y), s = around(double(a.pixel_x - b.pixel_x)),
                 t = around(double(a.pixel_y - b.pixel_y));
    return 1 / (x * x + y * y + pixel_square * (s * s + t * t) + 1e-9);
}

class Shares {
public:
    explicit Shares(std::size_t moments) : shares_(moments), served_(moments) {}

    // Gives the point to the moment whose points lie farthest from it. Each moment takes one before any takes another.
    void add(const LensSample &point) {
        std::size_t chosen = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t m = 0; m < shares_.size(); ++m) {
            if (served_[m]) continue;
            const double crowd = crowd_at(point, shares_[m]);
            if (crowd < least) least = crowd, chosen = m;
        }
        shares_[chosen].push_back(point);
        served_[chosen] = true;
        if (std::ranges::find(served_, false) == served_.end()) served_.assign(served_.size(), false);
    }
    std::vector<LensSample> take(std::size_t moment) { return std::move(shares_[moment]); }

private:
    static double crowd_at(const LensSample &point, const std::vector<LensSample> &share) {
        double crowd = 0;
        for (std::size_t i = share.size() - std::min(share.size(), most_compared); i < share.size(); ++i)
            crowd += closeness(point, share[i]);
        return crowd;
    }

    std::vector<std::vector<LensSample>> shares_;
    std::vector<bool> served_; // in this round
};

} // namespace

std::vector<LensSample> shared_points(std::vector<LensSample> points, const LensShare &share) {
    const auto moments = std::size_t(share.moments), moment = std::size_t(share.moment);
    if (moments == 1) return points;
    if (points.size() < moments) return {points[moment * points.size() / moments]};
    Shares shares(moments);
    for (const LensSample &point : points) shares.add(point);
    return shares.take(moment);
}

} // namespace sparselens
