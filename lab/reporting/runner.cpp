#include "lab/reporting/runner.h"

#include "base/error.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "lab/reporting/files.h"
#include "lab/reporting/process.h"
#include "lab/reporting/time_left.h"
#include "lab/tracing/camera_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>

namespace sparselens::lab {

namespace {

namespace fs = std::filesystem;

// FNV-1a, 64 bits. It distinguishes contents; it does not protect against forgery.
std::uint64_t hash_of(const std::string &bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3;
    return hash;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

class Runner {
public:
    explicit Runner(const RunOptions &options) : options_(options) {}

    // Identifies a step: equal if and only if running it again would give the same result.
    std::string identity(const Step &step, const std::vector<std::string> &inputs) {
        std::string text = fmt::format("threads {}\n", options_.threads);
        for (const StepCommand &command : step.commands)
            text += program_hash(command.words[0]) + ' ' + command_line(command.words) + '\n';
        for (const std::string &input : inputs) text += input + '\n';
        for (const std::string &file : step.given)
            text += file + ' ' + fmt::to_string(fs::file_size(file)) + ' ' +
                    fmt::to_string(fs::last_write_time(file).time_since_epoch().count()) + '\n';
        if (step.timed) text += fmt::format("runs {}\n", options_.runs);
        return fmt::to_string(hash_of(text));
    }

    std::optional<StepTimes> recorded(const Step &step, const std::string &identity) const {
        const auto there = [&](const std::string &file) { return fs::exists(path(file)); };
        if (!std::ranges::all_of(step.outputs, there) || !there(record_of(step))) return {};
        try {
            const auto json = read_json_file(path(record_of(step)).string());
            if (json.at("identity") != identity) return {};
            return StepTimes{json.at("seconds"), json.at("peak_mb"), json.at("runs")};
        } catch (const nlohmann::json::exception &) {
            return {}; // written by another version
        } catch (const Error &) {
            return {}; // left by an interrupted run
        }
    }

    StepTimes run(const Step &step, const std::string &identity) const {
        fs::remove(path(record_of(step)));
        for (const std::string &file : step.outputs) make_folder(path(file).parent_path().string());
        if (!step.fresh.empty()) {
            fs::remove_all(path(step.fresh));
            make_folder(path(step.fresh));
        }
        const StepTimes times = timed(step);
        if (step.scratch) fs::remove_all(path(step.fresh));
        nlohmann::ordered_json json{{"identity", identity}};
        for (const StepCommand &command : step.commands)
            json["commands"].push_back(command_line(command.words));
        json["seconds"] = times.seconds;
        json["peak_mb"] = times.peak_mb;
        json["runs"] = times.runs;
        write_file(path(record_of(step)), json.dump(1) + '\n');
        return times;
    }

private:
    fs::path path(const std::string &file) const { return fs::path(options_.folder) / file; }
    static std::string record_of(const Step &step) { return "steps/" + step.name + ".json"; }

    std::string program_hash(const std::string &program) {
        auto [found, is_new] = programs_.try_emplace(program);
        if (is_new)
            found->second =
                fmt::to_string(hash_of(read_bytes((fs::path(options_.tools) / program).string())));
        return found->second;
    }

    StepTimes once(const Step &step) const {
        StepTimes times;
        for (const StepCommand &command : step.commands) {
            std::vector<std::string> words = with_files(command.words, options_.folder);
            words[0] = (fs::path(options_.tools) / words[0]).string();
            words.insert(words.end(), {"--threads", fmt::to_string(options_.threads)});
            if (options_.max_memory)
                words.insert(words.end(), {"--max-memory", fmt::to_string(*options_.max_memory)});
            const ProcessRun run = run_process(words, options_.folder);
            times.seconds[std::size_t(command.stage)] += run.seconds;
            times.peak_mb = std::max(times.peak_mb, run.peak_mb);
        }
        if (!step.uncounted.empty()) {
            const CameraSummary camera = read_camera_summary(path(step.traced));
            for (const std::string &picture : step.uncounted)
                if (const auto found = camera.seconds.find(picture); found != camera.seconds.end())
                    times.seconds[std::size_t(Stage::render)] -= found->second;
        }
        return times;
    }

    StepTimes timed(const Step &step) const {
        std::vector<StepTimes> runs;
        double together = 0;
        while (runs.empty() ||
               (step.timed && int(runs.size()) < options_.runs && together < options_.enough)) {
            runs.push_back(once(step));
            for (const double seconds : runs.back().seconds) together += seconds;
        }
        StepTimes result{.runs = int(runs.size())};
        std::vector<double> values(runs.size());
        for (std::size_t s = 0; s < result.seconds.size(); ++s) {
            std::ranges::transform(runs, values.begin(), [&](const StepTimes &r) { return r.seconds[s]; });
            result.seconds[s] = median(values);
        }
        std::ranges::transform(runs, values.begin(), &StepTimes::peak_mb);
        result.peak_mb = median(values);
        return result;
    }

    RunOptions options_;
    std::map<std::string, std::string> programs_;
};

} // namespace

std::vector<StepTimes> run_steps(std::span<const Step> steps, const RunOptions &options,
                                 const ToolContext &tool) {
    Runner runner(options);
    std::vector<std::string> identities;
    std::vector<std::optional<StepTimes>> times;
    TimeLeft left(tool.tool_name);
    for (const Step &step : steps) {
        std::vector<std::string> inputs;
        for (const std::size_t input : step.inputs) inputs.push_back(identities[input]);
        identities.push_back(runner.identity(step, inputs));
        times.push_back(runner.recorded(step, identities.back()));
        if (!times.back()) left.expect(step.weight);
    }
    std::vector<StepTimes> result;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!times[i]) {
            left.begin(steps[i].name);
            tool.say(steps[i].name);
            times[i] = runner.run(steps[i], identities[i]);
            left.end(steps[i].weight);
        }
        result.push_back(*times[i]);
    }
    return result;
}

} // namespace sparselens::lab
