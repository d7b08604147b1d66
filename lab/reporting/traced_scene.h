// A built-in scene. dof-trace renders only the pictures that the rows need.
#pragma once

#include "lab/reporting/scene_source.h"

namespace sparselens::lab {

class TracedScene : public SceneSource {
public:
    TracedScene(std::string name, Budgets budgets, bool can_plan)
        : name_(std::move(name)), budgets_(std::move(budgets)), can_plan_(can_plan) {}

    std::string name() const override { return name_; }
    LensValues lens() const override { return {}; }
    double focus_distance() const override;
    std::vector<int> samples() const override { return budgets_.samples; }
    std::vector<int> rays() const override { return budgets_.rays; }
    std::vector<int> lens_views() const override { return budgets_.lens_views; }

    Rendered reference(StepList &steps) const override;
    std::optional<Rendered> views(int rim, int samples, StepList &steps) const override;
    std::vector<int> fine_samples() const override;
    std::optional<Rendered> fine_views(int rim, int samples, StepList &steps) const override;
    std::optional<Rendered> planned(int rim, int samples, StepList &steps) const override;
    std::optional<Rendered> layers(const std::string &kind, int samples, StepList &steps) const override;
    std::optional<Rendered> accumulated(int views, StepList &steps) const override;
    std::optional<Rendered> distributed(int rays, StepList &steps) const override;

private:
    StepCommand trace(const std::string &folder, int samples, int rim,
                      std::vector<std::string> more = {}) const;
    double weight(double rays) const;
    Rendered views(int rim, int samples, int supersample, StepList &steps) const;

    std::string name_;
    Budgets budgets_;
    bool can_plan_;
};

} // namespace sparselens::lab
