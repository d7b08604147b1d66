#include "match/measure_lens.h"

#include <gtest/gtest.h>

namespace sparselens {
namespace {

// Seven places in no order, around (3, -1).
const std::vector<Place> places{{3, -1},     {4.9, -1.2}, {2.7, 0.8}, {1.2, -1.1},
                                {3.4, -2.9}, {4.4, 0.3},  {2.1, -2.2}};

template <typename Function>
std::vector<double> values_of(const Function &function) {
    std::vector<double> values;
    for (const Place &place : places) values.push_back(function(place.x, place.y));
    return values;
}

double term(const Quadratic &of, std::size_t k, std::span<const double> values) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += of.shares(k)[i] * values[i];
    return sum;
}

TEST(Quadratic, has_the_terms_of_a_quadratic_function) {
    const auto values = values_of([](double x, double y) {
        const double u = (x - 3) / 2, v = (y + 1) / 2;
        return 7 + 2 * u - 3 * v + 5 * u * u / 2 - u * v - 4 * v * v / 2;
    });
    const Quadratic of(places, {3, -1}, 2);
    constexpr std::array<double, quadratic_terms> expected{7, 2, -3, 5, -1, -4};
    for (std::size_t k = 0; k < quadratic_terms; ++k)
        EXPECT_NEAR(term(of, k, values), expected[k], 0.01) << k;
}

TEST(Quadratic, finds_the_top_of_a_slanted_ridge) {
    const auto values = values_of([](double x, double y) {
        const double along = x - 3.6 + y + 1.5, across = x - 3.6 - y - 1.5;
        return 100 - 0.02 * along * along - 3 * across * across;
    });
    const Place best = Quadratic(places, {3, -1}, 2).best(values);
    EXPECT_NEAR(best.x, 3.6, 0.05);
    EXPECT_NEAR(best.y, -1.5, 0.05);
}

TEST(Quadratic, goes_no_farther_than_its_reach) {
    const Quadratic of(places, {3, -1}, 2);
    const Place uphill = of.best(values_of([](double x, double y) { return 3 * x + 4 * y; }));
    EXPECT_NEAR(uphill.x, 3 + 2 * 0.6, 0.1);
    EXPECT_NEAR(uphill.y, -1 + 2 * 0.8, 0.1);
    EXPECT_NEAR(distance(uphill, {3, -1}), 2, 1e-9);
    const Place from_a_valley =
        of.best(values_of([](double x, double y) { return (x - 3.5) * (x - 3.5) + y * 0; }));
    EXPECT_NEAR(from_a_valley.x, 1, 0.1);
}

TEST(Quadratic, what_places_do_not_tell_is_small) {
    const std::vector<Place> line{{0, 0}, {1, 0}, {-1, 0}};
    const std::vector<double> values{4, 3.5, 2.5};
    const Quadratic of(line, {0, 0}, 1);
    EXPECT_NEAR(term(of, 1, values), 0.5, 0.01);
    EXPECT_NEAR(term(of, 3, values), -2, 0.01);
    EXPECT_NEAR(term(of, 2, values), 0, 1e-6);
    EXPECT_NEAR(of.best(values).x, 0.25, 0.02);
}

} // namespace
} // namespace sparselens
