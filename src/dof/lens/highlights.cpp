#include "dof/lens/highlights.h"

#include "base/parallel.h"
#include "lens/lamp_spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace sparselens {

namespace {

constexpr int cell = BrightShare::cell;
constexpr float near_focus = GatherTuning::lamp_near_focus_px, wholly = GatherTuning::lamp_wholly;
constexpr double rare = GatherTuning::lamp_rare, common = GatherTuning::lamp_common;

struct Found {
    std::uint32_t sample;
    float share; // share of its light that is spread, (0, 1]
};

// Looks at cells, and at windows of two by two cells. Each cell lies in four windows, so that no lamp is missed at the
// edge of a window.
class HighlightFinder {
public:
    HighlightFinder(const Ldi &ldi, const BlockedSamples &samples, std::span<const std::size_t> channels,
                    const SampleColours &colours, const std::optional<PositionBox> &seen);
    std::vector<Found> find() const;

private:
    float brightness_of(std::uint32_t sample) const {
        float most = 0;
        for (const std::size_t k : channels_) most = std::max(most, colours_.at(k, sample));
        return most;
    }
    // visit(sample) for the samples of the cells in a box, without volumes.
    template <typename Visit>
    void for_each_sample(const PositionBox &cells, const Visit &visit) const;
    // A transparent pixel beyond the frame is as well known as the frame's pixel beside it.
    bool is_seen(std::uint32_t sample) const {
        if (!seen_ || samples_.source[sample] == BlockedSamples::background) return true;
        return seen_->contains(
            Position(int(std::floor(samples_.x[sample])), int(std::floor(samples_.y[sample]))));
    }
    enum class Of { seen, seen_and_covered, all };
    // What a window holds besides samples that were seen. If it holds nothing else, its levels are the same.
    struct Besides {
        bool background = false, unseen = false;
    };
    float level_of(const PositionBox &cells, Of of, Besides &besides) const;
    std::vector<Found> find_in(const Position &at) const;

    const Ldi &ldi_;
    const BlockedSamples &samples_;
    std::span<const std::size_t> channels_;
    const SampleColours &colours_;
    const std::optional<PositionBox> &seen_;
    ArrayGrid cells_, windows_; // a window's lower right cell is the one of its own column and row
    std::vector<float> levels_, covered_levels_; // with backgrounds, and without
    std::vector<float> made_up_levels_;          // with samples beyond the frame
    BrightShare as_bright_;
};

HighlightFinder::HighlightFinder(const Ldi &ldi, const BlockedSamples &samples,
                                 std::span<const std::size_t> channels, const SampleColours &colours,
                                 const std::optional<PositionBox> &seen)
    : ldi_(ldi), samples_(samples), channels_(channels), colours_(colours), seen_(seen),
      cells_(pieces_of(samples.columns, cell), pieces_of(samples.rows, cell)),
      windows_(cells_.width() + 1, cells_.height() + 1), levels_(windows_.size()),
      covered_levels_(windows_.size()), made_up_levels_(windows_.size()),
      as_bright_(ldi, samples, [this](std::uint32_t i) { return brightness_of(i); }) {
    parallel_for(windows_.size(), [&](std::size_t i) {
        const Position last = windows_.position(i);
        const PositionBox window{last - Imath::V2i(1), last};
        Besides besides;
        const float level = level_of(window, Of::seen, besides);
        levels_[i] = level;
        covered_levels_[i] = besides.background ? level_of(window, Of::seen_and_covered, besides) : level;
        made_up_levels_[i] = besides.unseen ? level_of(window, Of::all, besides) : level;
    });
}

template <typename Visit>
void HighlightFinder::for_each_sample(const PositionBox &cells, const Visit &visit) const {
    const int last_row = std::min((cells.max.row + 1) * cell, samples_.rows),
              last_column = std::min((cells.max.column + 1) * cell, samples_.columns);
    for (int row = std::max(cells.min.row * cell, 0); row < last_row; ++row)
        for (int column = std::max(cells.min.column * cell, 0); column < last_column; ++column) {
            const SampleBlock &block = samples_.blocks[std::size_t(row * samples_.columns + column)];
            for (std::uint32_t i = block.begin; i < block.end; ++i)
                if (counts_as(ldi_, samples_, i) > 0) visit(i);
        }
}

// Returns the level that all but the brightest samples of a window stay below.
float HighlightFinder::level_of(const PositionBox &cells, Of of, Besides &besides) const {
    std::vector<CoveredLight> levels, all;
    for_each_sample(cells, [&](std::uint32_t i) {
        const bool background = samples_.source[i] == BlockedSamples::background, seen = is_seen(i);
        besides.background = besides.background || background;
        besides.unseen = besides.unseen || !seen;
        if (of == Of::seen_and_covered && background) return;
        (of == Of::all || seen ? levels : all).push_back({brightness_of(i), counts_as(ldi_, samples_, i)});
    });
    if (levels.empty()) levels = std::move(all);
    return surroundings_of(std::span(levels), LampTuning::one_in);
}

// How much a disc shows: [0, 1]. `ratio`: of the lamp's brightness to its surroundings.
float seen_of_disc(float ratio, float coc) {
    const float unseen = GatherTuning::lamp_least_variance * std::numbers::pi_v<float> * coc * coc;
    return ratio * ratio < 2 * unseen ? std::max(ratio * ratio / unseen - 1, 0.0f) : 1;
}

std::vector<Found> HighlightFinder::find_in(const Position &at) const {
    const auto level_in = [&](const std::vector<float> &levels) {
        const auto level_at = [&](int x, int y) { return levels[windows_.index(at + Imath::V2i(x, y))]; };
        return std::min({level_at(0, 0), level_at(1, 0), level_at(0, 1), level_at(1, 1)});
    };
    const float any_level = level_in(levels_), covered_level = level_in(covered_levels_),
                made_up_level = level_in(made_up_levels_);
    std::vector<Found> found;
    for_each_sample({at, at}, [&](std::uint32_t i) {
        const float brightness = brightness_of(i);
        float level = std::abs(samples_.coc[i]) < near_focus ? covered_level : any_level;
        if (!is_seen(i)) level = std::max(level, made_up_level); // so that few of them are highlights, too
        if (!stands_out(brightness, level)) return;
        // Only few samples stand out of empty surroundings, and exact discs are better than lens points.
        const double rarity =
            covered_level > any_level
                ? 1
                : std::clamp((common - as_bright_.around(i, brightness)) / (common - rare), 0.0, 1.0);
        if (!(rarity > 0)) return;
        constexpr float least = LampTuning::stands_out;
        const float ratio = brightness / level, coc = samples_.coc[i];
        const float wholeness = std::min((ratio - least) / (wholly - least), 1.0f) * seen_of_disc(ratio, coc);
        if (wholeness > 0) found.push_back({i, float(rarity) * wholeness * (1 - level / brightness)});
    });
    return found;
}

std::vector<Found> HighlightFinder::find() const {
    std::vector<Found> all =
        joined(cells_.size(), [&](std::size_t i) { return find_in(cells_.position(i)); });
    std::ranges::sort(all, {}, &Found::sample);
    return all;
}

SampleColours no_light(std::size_t groups, std::size_t count) {
    return {groups, count, LargeArray<float>(groups * count * 4, 0.0f)};
}

Imath::V2f place_of(const BlockedSamples &samples, std::uint32_t i, const Imath::V2i &corner) {
    return Imath::V2f(samples.x[i], samples.y[i]) + Imath::V2f(corner);
}

// How many discs make the streak of a lamp, so that they overlap by most of their width.
int pieces_along(const LampMotion &motion, float coc) {
    const float step = std::max(GatherTuning::lamp_step_px, GatherTuning::lamp_step_of_coc * std::abs(coc)),
                length =
                    (motion.at(0.5f) - motion.at(0)).length() + (motion.at(0) - motion.at(-0.5f)).length();
    return std::clamp(int(std::ceil(length / step)), 1, GatherTuning::most_lamp_steps);
}

} // namespace

Highlights take_highlights(const Ldi &ldi, const BlockedSamples &samples, SampleColours &colours,
                           const std::optional<PositionBox> &seen) {
    const LightChannels light = light_channels(ldi);
    const std::vector<Found> all = HighlightFinder(ldi, samples, light.brightness, colours, seen).find();
    Highlights highlights;
    highlights.light = no_light(colours.groups, all.size());
    for (const Found &f : all) {
        for (const std::size_t k : light.all) {
            highlights.light.at(k, highlights.sample.size()) = f.share * colours.at(k, f.sample);
            colours.at(k, f.sample) *= 1 - f.share;
        }
        highlights.sample.push_back(f.sample);
        highlights.share.push_back(f.share);
    }
    highlights.groups = HighlightGroups(highlights.among(samples));
    return highlights;
}

std::vector<LampPart> lamp_parts(const Highlights &highlights, const BlockedSamples &samples,
                                 std::span<const std::size_t> brightness, const Imath::V2i &corner) {
    std::vector<LampPart> parts;
    for (std::size_t n = 0; n < highlights.sample.size(); ++n) {
        const std::uint32_t i = highlights.sample[n];
        LampPart part{place_of(samples, i, corner), samples.depth(i), {}};
        for (std::size_t k = 0; k < std::min(brightness.size(), part.light.size()); ++k)
            part.light[k] = highlights.light.at(brightness[k], n);
        parts.push_back(part);
    }
    return parts;
}

void spread_along(const LampPaths &paths, const BlockedSamples &samples, const Imath::V2i &corner,
                  Highlights &highlights) {
    struct Piece {
        std::size_t of;
        Imath::V2f moved;
        float part;
    };
    std::vector<Piece> pieces;
    for (std::size_t n = 0; n < highlights.sample.size(); ++n) {
        const std::uint32_t i = highlights.sample[n];
        const LampMotion *motion = paths.of(place_of(samples, i, corner), samples.depth(i));
        const int count = motion ? pieces_along(*motion, samples.coc[i]) : 1;
        for (int piece = 0; piece < count; ++piece) {
            const float time = (float(piece) + 0.5f) / float(count) - 0.5f;
            pieces.push_back({n, motion ? motion->at(time) : Imath::V2f(0), 1 / float(count)});
        }
    }
    if (pieces.size() == highlights.sample.size()) return; // none moves far enough
    Highlights spread;
    spread.light = no_light(highlights.light.groups, pieces.size());
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const auto &[of, moved, part] = pieces[p];
        spread.sample.push_back(highlights.sample[of]);
        spread.moved.push_back(moved);
        spread.share.push_back(part * highlights.share[of]);
        for (std::size_t k = 0; k < spread.light.groups * 4; ++k)
            spread.light.at(k, p) = part * highlights.light.at(k, of);
    }
    spread.groups = HighlightGroups(spread.among(samples));
    highlights = std::move(spread);
}

namespace {

constexpr float group_of_coc = GatherTuning::lamp_group_of_coc;

// The size of a group, pixels: a power of two, so that groups do not change with every change of the focus; a block at
// most.
int group_size(float coc) {
    int size = 1;
    while (size < BlockedSamples::size && float(2 * size) <= group_of_coc * std::abs(coc)) size *= 2;
    return size;
}

// The values that the members of one group have in common.
auto key_of(const PlacedHighlights &highlights, std::uint32_t h) {
    const std::uint32_t i = highlights.sample[h];
    const int size = group_size(highlights.samples.coc[i]);
    const auto step_of = [](float v, double step) { return std::int64_t(std::floor(double(v) / step)); };
    const Imath::V2f at = highlights.place(h);
    return std::tuple(size, step_of(at.x, size), step_of(at.y, size),
                      step_of(highlights.samples.depth(i), one_surface_px), size > 1 ? 0 : h);
}

} // namespace

HighlightGroups::HighlightGroups(const PlacedHighlights &highlights) {
    const auto key = [&](std::uint32_t h) { return key_of(highlights, h); };
    // Makes groups of the members from `first` on.
    const auto group = [&](std::size_t first) {
        std::stable_sort(members_.begin() + std::ptrdiff_t(first), members_.end(),
                         [&](auto a, auto b) { return key(a) < key(b); });
        for (std::size_t n = first; n < members_.size(); ++n)
            if (n == first || key(members_[n - 1]) != key(members_[n])) begin_.push_back(std::uint32_t(n));
    };
    std::vector<std::uint32_t> on_the_move;
    std::uint32_t h = 0;
    for (const SampleBlock &block : highlights.samples.blocks) {
        of_block_.push_back(std::uint32_t(begin_.size()));
        const std::size_t first = members_.size();
        for (; h < highlights.sample.size() && highlights.sample[h] < block.end; ++h)
            (highlights.is_moved(h) ? on_the_move : members_).push_back(h);
        group(first);
    }
    of_block_.push_back(std::uint32_t(begin_.size()));
    const std::size_t first_moved = members_.size();
    members_.insert(members_.end(), on_the_move.begin(), on_the_move.end());
    group(first_moved);
    begin_.push_back(std::uint32_t(members_.size()));
    moved_.resize(begin_.size() - 1 - of_block_.back());
    for (std::size_t n = 0; n < moved_.size(); ++n)
        for (const std::uint32_t member : members(of_block_.back() + n)) {
            moved_[n].box.extendBy(highlights.place(member));
            moved_[n].coc =
                std::max(moved_[n].coc, std::abs(highlights.samples.coc[highlights.sample[member]]));
        }
}

namespace {

constexpr double cell_px = GatherTuning::cell_px;
static_assert(BrightShare::cell * BlockedSamples::size == GatherTuning::cell_px);
constexpr double reach = cell_px; // as far as bands of rows let highlights look (gather_rows.cpp)
constexpr double half = GatherTuning::lamp_octave;

} // namespace

int BrightShare::octave_of(float brightness) {
    return brightness > 0 ? std::clamp(std::ilogb(brightness) + octaves / 2, 0, octaves - 1) : 0;
}

BrightShare::BrightShare(const Ldi &ldi, const BlockedSamples &samples,
                         const std::function<float(std::uint32_t)> &brightness)
    : samples_(samples), corners_(pieces_of(samples.columns, cell) + 1, pieces_of(samples.rows, cell) + 1),
      below_(octaves * corners_.size()) {
    const auto at = [&](int octave, int x, int y) -> double & {
        return below_[std::size_t(octave) * corners_.size() + corners_.index(Position(x, y))];
    };
    parallel_for(std::size_t(corners_.height() - 1), [&](std::size_t row) {
        const std::size_t columns = std::size_t(samples.columns), first = row * cell * columns,
                          last = std::min(first + cell * columns, samples.blocks.size());
        for (std::size_t b = first; b < last; ++b)
            for (std::uint32_t i = samples.blocks[b].begin; i < samples.blocks[b].end; ++i)
                at(octave_of(brightness(i)), int(b % columns) / cell + 1, int(row) + 1) +=
                    double(counts_as(ldi, samples, i));
    });
    for (int octave = octaves - 2; octave >= 0; --octave)
        for (std::size_t i = 0; i < corners_.size(); ++i)
            below_[std::size_t(octave) * corners_.size() + i] +=
                below_[std::size_t(octave + 1) * corners_.size() + i];
    for (int octave = 0; octave < octaves; ++octave)
        for (int y = 1; y < corners_.height(); ++y)
            for (int x = 1; x < corners_.width(); ++x)
                at(octave, x, y) += at(octave, x - 1, y) + at(octave, x, y - 1) - at(octave, x - 1, y - 1);
}

// Counts the samples in a box of cells: {left, top, right, bottom}. A part of a cell counts as that part of its
// samples.
double BrightShare::count(int octave, const std::array<double, 4> &box) const {
    const auto before = [&](double x, double y) {
        const int column = std::min(int(x), corners_.width() - 2),
                  row = std::min(int(y), corners_.height() - 2);
        const double right = x - column, down = y - row;
        const auto at = [&](int i, int j) {
            return below_[std::size_t(octave) * corners_.size() +
                          corners_.index(Position(column + i, row + j))];
        };
        return (1 - down) * ((1 - right) * at(0, 0) + right * at(1, 0)) +
               down * ((1 - right) * at(0, 1) + right * at(1, 1));
    };
    return before(box[2], box[3]) - before(box[0], box[3]) - before(box[2], box[1]) + before(box[0], box[1]);
}

double BrightShare::around(std::uint32_t sample, float brightness) const {
    const auto in_cells = [&](double v, int corners) {
        return std::clamp(v / cell_px, 0.0, double(corners - 1));
    };
    const double x = double(samples_.x[sample]), y = double(samples_.y[sample]);
    const std::array box{in_cells(x - reach, corners_.width()), in_cells(y - reach, corners_.height()),
                         in_cells(x + reach, corners_.width()), in_cells(y + reach, corners_.height())};
    const double all = count(0, box);
    if (!(all > 0)) return 0;
    const double octave =
        std::clamp(std::log2(double(std::max(brightness, 1e-30f))) - half + octaves / 2, 0.0, octaves - 1.0);
    const int whole = int(octave), next = std::min(whole + 1, octaves - 1);
    return std::clamp(std::lerp(count(whole, box), count(next, box), octave - whole) / all, 0.0, 1.0);
}

} // namespace sparselens
