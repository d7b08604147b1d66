#include "support/views.h"
#include "warp/coverage.h"

#include <gtest/gtest.h>

#include <limits>

namespace sparselens {
namespace {

constexpr double focal_px = 100, tolerance = 0.05; // in 1 / z: 2 and 10 are two surfaces

// A card at z = 2 before a wall at z = 10, seen by cameras at these distances.
class Views {
public:
    Views(const TwoPlanes &scene, const std::vector<Imath::V2d> &cameras) {
        for (const Imath::V2d &camera : cameras)
            views_.push_back(scene.view(windows_of_size(40, 10), camera));
    }
    double coverage(double x, double y, double z) const {
        return coverage_by_majority(
            votes_on(ReprojectedViews(views_, focal_px, 1, 0), {x, y}, 1 / z, tolerance));
    }

private:
    std::vector<View> views_;
};

TwoPlanes card_up_to(double right) {
    TwoPlanes scene;
    scene.front_covers = [right](double x, double) { return x < right; };
    return scene;
}

// Cameras with half a pixel of parallax between them at the card. Each sees the card's edge at its pixel centres.
const std::vector<Imath::V2d> cameras{{0, 0}, {0.01, 0}, {0.02, 0}, {0.03, 0}, {0.04, 0}};

TEST(VisibilityVote, IsWholeWhereAllSeeItAndGoneWhereNoneDoes) {
    const Views views(card_up_to(20), cameras);
    EXPECT_EQ(views.coverage(12, 5, 2), 1);
    EXPECT_EQ(views.coverage(26, 5, 2), 0); // all views look past it
    EXPECT_EQ(views.coverage(26, 5, 10), 1);
}

// A view does not vote on a point that something hides, or that is outside its frame.
TEST(VisibilityVote, WhoCannotTellDoesNotVote) {
    const Views views(card_up_to(20), cameras);
    EXPECT_EQ(views.coverage(5, 5, 10), 1); // behind the card: no view saw it
    EXPECT_EQ(views.coverage(300, 5, 2), 1);
    EXPECT_EQ(views.coverage(-1e30, 5, 2), 1);
    EXPECT_EQ(views.coverage(12, 5, std::numeric_limits<double>::infinity()), 1);
}

// One of two views sees it: between a quarter and three quarters, coverage is proportional.
TEST(VisibilityVote, AnEdgeIsSharedByMajority) {
    TwoPlanes with = card_up_to(20), without = card_up_to(-100);
    const Windows w = windows_of_size(40, 10);
    const auto coverage = [&](int there, int past) {
        std::vector<View> views{with.view(w, {0, 0})};
        for (int i = 0; i < there; ++i) views.push_back(with.view(w, {0.02, 0}));
        for (int i = 0; i < past; ++i) views.push_back(without.view(w, {0.02, 0}));
        return coverage_by_majority(
            votes_on(ReprojectedViews(views, focal_px, 1, 0), {12, 5}, 0.5, tolerance));
    };
    EXPECT_EQ(coverage(3, 1), 1);
    EXPECT_DOUBLE_EQ(coverage(5, 3), 0.75);
    EXPECT_DOUBLE_EQ(coverage(1, 1), 0.5);
    EXPECT_EQ(coverage(1, 3), 0);
    EXPECT_EQ(coverage(0, 1), 0);
}

// A veil covers part of the pixels that see it, and votes for itself with all of each: another view that sees a wall
// past it has no larger vote. A veil in front of a surface is a vote against the surface, and the open part of the veil
// is another.
TEST(VisibilityVote, WhatAVeilLeavesOpenIsNoVoteAgainstIt) {
    const Windows w = windows_of_size(8, 8);
    const auto coverage = [&](const std::vector<ViewPixel> &pixels, double z) {
        std::vector<View> views{make_view(w, {0, 0}, [](int, int) { return ViewPixel{.z = 2}; })};
        for (const ViewPixel &p : pixels) views.push_back(make_view(w, {0, 0}, [&](int, int) { return p; }));
        return coverage_by_majority(
            votes_on(ReprojectedViews(views, focal_px, 1, 0), {4, 4}, 1 / z, tolerance));
    };
    const ViewPixel veil{.z = 2, .a = 0.3f}, wall{.z = 10};
    EXPECT_EQ(coverage({veil}, 2), 1);
    EXPECT_EQ(coverage({veil, veil, veil}, 2), 1);
    EXPECT_DOUBLE_EQ(coverage({veil, wall}, 2), 0.5);
    EXPECT_DOUBLE_EQ(coverage({veil, veil, veil, wall, wall, wall}, 2), 0.5);
    EXPECT_EQ(coverage({veil}, 10), 0); // it looks past the wall's position
}

TEST(VisibilityVote, IsHalfMajorityHalfMean) {
    EXPECT_DOUBLE_EQ(coverage_by_votes({.there = 4}, 1), 1);
    EXPECT_DOUBLE_EQ(coverage_by_votes({.there = 2, .past = 2}, 1), 0.5);
    EXPECT_DOUBLE_EQ(coverage_by_votes({.there = 1, .past = 3}, 1), 0.5 * 0.25); // by majority 0
    EXPECT_DOUBLE_EQ(coverage_by_votes({.there = 3, .past = 1}, 1), 0.5 * (1 + 0.75));
    EXPECT_DOUBLE_EQ(coverage_by_votes({}, 1), 1); // no view can tell
}

// Samples that show a third of their pixels are not made less where each view shows a third: they are the mean.
TEST(VisibilityVote, PartsOfPixelsAreMeansAlready) {
    const Votes thirds{.there = 4 / 3.0, .past = 8 / 3.0, .open = 0, .through = 8 / 3.0};
    EXPECT_DOUBLE_EQ(coverage_by_votes(thirds, 1 / 3.0), 1);
    EXPECT_DOUBLE_EQ(coverage_by_votes(thirds, 2 / 3.0), 0.75); // the samples are those with the most
}

} // namespace
} // namespace sparselens
