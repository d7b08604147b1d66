// A folder of ready-made views, whose camera.json holds their positions and render times.
#pragma once

#include "lab/reporting/scene_source.h"
#include "lab/tracing/camera_json.h"

#include <filesystem>

namespace sparselens::lab {

class ReadyScene : public SceneSource {
public:
    // Throws Error if the folder lacks its reference, or a camera.json in it cannot be read.
    explicit ReadyScene(const std::filesystem::path &folder);

    std::string name() const override { return name_; }
    LensValues lens() const override;
    double focus_distance() const override { return camera_.focus_distance; }
    std::vector<int> samples() const override;
    std::vector<int> rays() const override { return rays("exr"); }
    std::vector<int> denoised_rays() const override { return rays("denoised.exr"); }
    std::vector<int> lens_views() const override { return {}; }

    std::vector<int> fine_samples() const override;
    std::vector<Finished> finished() const override;

    Rendered reference(StepList &steps) const override;
    std::optional<Rendered> views(int rim, int samples, StepList &) const override {
        return views(views_, rim, samples, "exr");
    }
    std::optional<Rendered> denoised_views(int rim, int samples, StepList &) const override {
        return views(views_, rim, samples, "denoised.exr");
    }
    std::optional<Rendered> fine_views(int rim, int samples, StepList &) const override {
        return views(fine_, rim, samples, "exr");
    }
    std::optional<Rendered> denoised_fine_views(int rim, int samples, StepList &) const override {
        return views(fine_, rim, samples, "denoised.exr");
    }
    std::optional<Rendered> planned(int, int, StepList &) const override { return {}; }
    std::optional<Rendered> layers(const std::string &, int, StepList &) const override { return {}; }
    std::optional<Rendered> accumulated(int, StepList &) const override { return {}; }
    std::optional<Rendered> distributed(int rays, StepList &) const override {
        return distributed(rays, "exr");
    }
    std::optional<Rendered> denoised(int rays, StepList &) const override {
        return distributed(rays, "denoised.exr");
    }

private:
    struct ViewFolder {
        std::filesystem::path path;
        CameraSummary camera;
    };
    using ViewFolders = std::vector<ViewFolder>;

    // The ray counts per pixel of the files with this ending: as rendered, or denoised.
    std::vector<int> rays(const std::string &ending) const;
    std::optional<Rendered> views(const ViewFolders &folders, int rim, int samples,
                                  const std::string &ending) const;
    Rendered distributed(int rays, const std::string &ending) const;

    std::filesystem::path folder_;
    std::string name_;
    ViewFolders views_, fine_; // by samples per pixel, each count once; fine: larger than the picture
    CameraSummary camera_;     // of the folder itself
};

} // namespace sparselens::lab
