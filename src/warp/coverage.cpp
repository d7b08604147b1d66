#include "warp/coverage.h"

#include "base/light.h"
#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"

#include <optional>

namespace sparselens {

namespace {

// Counts the votes of one pixel of a view. Each sample votes by what it covers, and what the pixel leaves open looks
// past everything. A pixel that shows nothing at all does not vote, because it may not have been rendered.
void count_votes(const ViewSamples &view, std::size_t alpha, std::size_t pixel, double inverse_z,
                 double tolerance, const SeePast &past, Votes &votes) {
    if (view.pixel(pixel).empty()) return;
    double left = 1, there = 0, past_before = votes.past;
    for (const std::uint64_t i : view.pixel(pixel)) {
        const double own = double(alpha_at(view, alpha, i));
        const double covers = view.is_part(i) ? own * left : kernels::covers(own, left);
        const double nearer = 1 / double(view.z(i)) - inverse_z;
        if (std::abs(nearer) < tolerance)
            there += covers;
        else if (nearer < 0) {
            votes.past += covers;
            if (past && covers > 0) past(view, i, covers);
        }
        left -= covers;
    }
    votes.there += there;
    votes.past += left;
    votes.open += left;
    if (there > 0) votes.through += view.deep() ? votes.past - past_before : left;
}

} // namespace

Votes votes_on(const ReprojectedViews &views, const Imath::V2d &place, double inverse_z, double tolerance,
               const SeePast &past) {
    const std::size_t alpha = views.samples(0).alpha();
    Votes votes;
    for (std::size_t v = 1; v < views.size(); ++v) {
        const ViewSamples &view = views.samples(v);
        const Imath::V2d seen = views.reprojection(v).mapping().in_view(place, inverse_z);
        const Imath::Box2i &data = view.windows.data;
        if (!kernels::lies_in(seen.x, data.min.x, data.max.x)) continue;
        if (!kernels::lies_in(seen.y, data.min.y, data.max.y)) continue;
        const std::size_t pixel =
            view.windows.index(Imath::V2i(int(std::floor(seen.x)), int(std::floor(seen.y))));
        count_votes(view, alpha, pixel, inverse_z, tolerance, past, votes);
    }
    return votes;
}

double coverage_by_majority(const Votes &votes) {
    return kernels::coverage_by_majority(votes.there, votes.past, votes.through);
}

double coverage_by_votes(const Votes &votes, double shown) {
    return kernels::coverage_by_votes(votes.there, votes.past, votes.through, shown);
}

namespace {

// A share of a sample of a view.
struct Part {
    const ViewSamples *view;
    std::uint64_t sample;
    double share;
};

class OpacityRepair {
public:
    OpacityRepair(const ReprojectedViews &views, double tolerance, Ldi &ldi)
        : views_(views), tolerance_(tolerance), ldi_(ldi), alpha_(ldi.alpha()),
          mattes_(find_mattes(ldi.channels)) {}

    void fill_pixel(std::size_t pixel) {
        if (!lets_through(ldi_, alpha_, ldi_.pixel(pixel))) return;
        const auto last = last_sample(pixel);
        const Imath::V2i at = ldi_.windows.pixel(pixel);
        const ViewSamples &centre = views_.samples(0);
        const bool in_frame = centre.windows.data.intersects(at);
        if (!last || (in_frame && lets_through(centre, alpha_, centre.pixel(centre.windows.index(at)))))
            return;
        std::vector<Part> past;
        const Votes votes = ask(at, *last, past);
        if (lets_through(votes.past)) // more than rounding
            fill(*last, 1, past);
        else if (votes.there > 0 || in_frame)
            fill(*last, 1 / double(ldi_.values[alpha_][*last]), {});
    }

private:
    // The last sample whose coverage is more than rounding.
    std::optional<std::uint64_t> last_sample(std::size_t pixel) const {
        std::optional<std::uint64_t> last;
        for (const std::uint64_t i : ldi_.pixel(pixel))
            if (lets_through(double(ldi_.values[alpha_][i]))) last = i;
        return last;
    }

    // Returns what the rim views see at a sample. `past` receives what they see past it, as shares of what the sample
    // leaves open.
    Votes ask(const Imath::V2i &pixel, std::uint64_t sample, std::vector<Part> &past) const {
        const Imath::V2d place(pixel.x + 0.5 + double(ldi_.dx[sample]),
                               pixel.y + 0.5 + double(ldi_.dy[sample]));
        const Votes votes =
            votes_on(views_, place, 1 / double(ldi_.z[sample]), tolerance_,
                     [&](const ViewSamples &view, std::uint64_t i, double covers) {
                         past.push_back({&view, i, covers / double(alpha_at(view, alpha_, i))});
                     });
        const double left = 1 - double(ldi_.values[alpha_][sample]);
        for (Part &part : past) part.share *= left / votes.past;
        return votes;
    }

    // Replaces a sample by `factor` times itself plus the parts.
    void fill(std::uint64_t sample, double factor, std::span<const Part> parts) {
        MatteSum pairs(mattes_);
        pairs.add(factor, [&](std::size_t k) { return ldi_.values[k][sample]; });
        for (const Part &part : parts)
            pairs.add(part.share, [&](std::size_t k) { return part.view->value(k, part.sample); });
        for (std::size_t k = 0; k < ldi_.channels.size(); ++k) {
            if (holds_ids(ldi_.channels[k])) continue;
            double sum = factor * double(ldi_.values[k][sample]);
            for (const Part &part : parts) sum += part.share * double(part.view->value(k, part.sample));
            ldi_.values[k][sample] = float(sum);
        }
        pairs.take([&](std::size_t k, float value) { ldi_.values[k][sample] = value; });
        float &covers = ldi_.values[alpha_][sample]; // the sum of its parts' coverages, and rounding
        if (!lets_through(1 - double(covers))) covers = 1;
    }

    const ReprojectedViews &views_;
    double tolerance_;
    Ldi &ldi_;
    std::size_t alpha_;
    std::vector<Matte> mattes_;
};

} // namespace

void keep_opaque(const ReprojectedViews &views, double tolerance, Ldi &ldi) {
    if (ldi.alpha() == npos) return;
    OpacityRepair repair(views, tolerance, ldi);
    parallel_ranges(ldi.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) repair.fill_pixel(pixel);
    });
}

} // namespace sparselens
