// Finds which blocks of a scene tiles are gathered from.
#pragma once

#include "dof/device/tile_device.h"
#include "dof/lens/gather_scene.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sparselens::gpu {

// A range of blocks, and of the samples or facets in them, which follow each other.
struct Range {
    std::uint32_t first_block = ~0u, end_block = 0;

    void add(std::uint32_t first, std::uint32_t last) {
        first_block = std::min(first_block, first);
        end_block = std::max(end_block, last + 1);
    }
    void add(std::span<const std::uint32_t> blocks) { // in ascending order
        if (!blocks.empty()) add(blocks.front(), blocks.back());
    }
    void add_all(const auto &of) {
        if (!of.blocks.empty()) add(0, std::uint32_t(of.blocks.size() - 1));
    }
    std::size_t blocks() const { return first_block < end_block ? end_block - first_block : 0; }
    std::uint32_t first(const auto &of) const { return blocks() > 0 ? of.blocks[first_block].begin : 0; }
    std::size_t count(const auto &of) const {
        return blocks() > 0 ? of.blocks[end_block - 1].end - first(of) : 0;
    }
};

// The ranges of a scene that tiles are gathered from.
struct Ranges {
    Range samples, fillers, facets, solids;

    void add(const GatherScene &scene, const TileTask &task) {
        samples.add(task.samples);
        fillers.add(task.fillers);
        facets.add(task.facets);
        solids.add(task.solids);
        for (const std::uint32_t b : task.facets)
            for (const auto &corners : scene.facets.key) add_named(scene, corners, scene.facets.blocks[b]);
        for (const std::uint32_t b : task.solids)
            add_named(scene, scene.solids.named, scene.solids.blocks[b]);
    }
    void add_all(const GatherScene &scene) {
        samples.add_all(scene.samples);
        fillers.add_all(scene.fillers.samples);
        facets.add_all(scene.facets);
        if (!scene.one_view) solids.add_all(scene.solids);
    }
    std::size_t sample_count(const GatherScene &scene) const {
        return samples.count(scene.samples) + fillers.count(scene.fillers.samples);
    }

private:
    // Adds the samples that the lower halves of a block's keys name (`keys`). A facet can reach a tile that some of its
    // corners do not reach, and a solid can reach a tile that the sample which it shows does not reach.
    void add_named(const GatherScene &scene, const auto &keys, const auto &block) {
        std::uint32_t least = ~0u, most = 0;
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            least = std::min(least, std::uint32_t(keys[i]));
            most = std::max(most, std::uint32_t(keys[i]));
        }
        if (least <= most) samples.add(block_of(scene.samples, least), block_of(scene.samples, most));
    }
    static std::uint32_t block_of(const BlockedSamples &samples, std::uint32_t sample) {
        const auto after = std::ranges::upper_bound(samples.blocks, sample, {}, &SampleBlock::begin);
        return std::uint32_t(after - samples.blocks.begin() - 1);
    }
};

} // namespace sparselens::gpu
