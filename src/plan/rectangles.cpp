#include "plan/rectangles.h"

#include "plan/tuning.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

double area(const Imath::Box2i &box) {
    return box.isEmpty() ? 0 : double(box.max.x - box.min.x + 1) * double(box.max.y - box.min.y + 1);
}

Imath::Box2i together(Imath::Box2i a, const Imath::Box2i &b) {
    a.extendBy(b);
    return a;
}

// The number of pixels that one rectangle for both boxes asks for in vain.
double waste(const Imath::Box2i &a, const Imath::Box2i &b) {
    return area(together(a, b)) - area(a) - area(b);
}

// The set pixels of a band of rows as tight boxes. A new box begins where columns stay empty for a while.
std::vector<Imath::Box2i> boxes_of_band(const PixelMask &mask, int first_row, int last_row) {
    std::vector<Imath::Box2i> boxes;
    for (int x = mask.data.min.x; x <= mask.data.max.x; ++x)
        for (int y = first_row; y <= last_row; ++y) {
            if (!mask.at(x, y)) continue;
            if (boxes.empty() || x - boxes.back().max.x > PlanTuning::rectangle_gap) boxes.emplace_back();
            boxes.back().extendBy(Imath::V2i(x, y));
        }
    return boxes;
}

// Joins each box of a band with the box above with which it wastes least, if that pays.
void join_band(const std::vector<Imath::Box2i> &band, int first_row, std::vector<Imath::Box2i> &boxes) {
    const std::size_t above = boxes.size();
    for (const Imath::Box2i &box : band) {
        Imath::Box2i *best = nullptr;
        double least = PlanTuning::rectangle_overhead;
        for (std::size_t i = 0; i < above; ++i) {
            if (boxes[i].max.y < first_row - PlanTuning::rectangle_gap || waste(boxes[i], box) >= least)
                continue;
            least = waste(boxes[i], box);
            best = &boxes[i];
        }
        if (best)
            best->extendBy(box);
        else
            boxes.push_back(box);
    }
}

// Joins the two boxes that waste least. Returns whether any were joined.
bool join_cheapest(std::vector<Imath::Box2i> &boxes, double limit) {
    std::size_t first = 0, second = 0;
    double least = limit;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = i + 1; k < boxes.size(); ++k)
            if (waste(boxes[i], boxes[k]) < least) {
                least = waste(boxes[i], boxes[k]);
                first = i;
                second = k;
            }
    if (first == second) return false;
    boxes[first].extendBy(boxes[second]);
    boxes.erase(boxes.begin() + std::ptrdiff_t(second));
    return true;
}

} // namespace

std::vector<Imath::Box2i> rectangles_over(const PixelMask &mask, std::size_t most) {
    const int band_rows = std::max(8, mask.height() / 64);
    std::vector<Imath::Box2i> boxes;
    for (int row = mask.data.min.y; row <= mask.data.max.y; row += band_rows)
        join_band(boxes_of_band(mask, row, std::min(row + band_rows - 1, mask.data.max.y)), row, boxes);
    while (boxes.size() > most && join_cheapest(boxes, std::numeric_limits<double>::infinity())) {
    }
    while (join_cheapest(boxes, PlanTuning::rectangle_overhead)) {
    }
    return boxes;
}

} // namespace sparselens
