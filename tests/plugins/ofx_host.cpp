// A small host of OpenFX, for scripts. It loads an effect and renders one picture.
//
//   ofx-host FILE.ofx describe                       prints contexts, clips and parameters
//   ofx-host FILE.ofx render CONTEXT OUT.exr WORD... writes R, G, B and A as floats, whatever the effect made
//
// Words: NAME=VALUE for a parameter, with keys as TIME:VALUE,TIME:VALUE; @size=WxH of the project and its picture; @time=T;
// @scale=S; @tiles=N renders windows of N x N pixels, @threads=N on N threads; @depth=byte|short|half|float;
// @components=RGB|RGBA; @rows=down; @unpremultiplied=1; @aspect=A of the pixels; @region=1 renders the region that the effect
// has, else the project; @source=EXR and @z=EXR of the scaled project's pixels; @kill=N renders N times more, and ends the
// gatherer at a random moment of each; @again=COMMAND renders again after the shell's COMMAND.
//
// Prints the status of the render, and the message that the effect shows. Exits with 0 whatever they are.

#include "ofx_canvas.h"

#include <dlfcn.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

namespace {

using namespace ofx_host;

[[noreturn]] void fail(const std::string &what) { throw std::runtime_error(what); }

// An effect that is loaded, with its host.
class Plugin {
public:
    Plugin(const char *file, const Words &words) {
        void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
        if (!library) fail(dlerror());
        const auto count = reinterpret_cast<int (*)()>(dlsym(library, "OfxGetNumberOfPlugins"));
        const auto get = reinterpret_cast<OfxPlugin *(*)(int)>(dlsym(library, "OfxGetPlugin"));
        if (!count || !get || count() != 1) fail("not an effect");
        plugin_ = get(0);
        host_.set<int>(kOfxImageEffectHostPropIsBackground, 0);
        host_.set<int>(kOfxImageEffectPropSupportsMultiResolution, words.yes("@region"));
        plugin_->setHost(make_host(host_));
        require(kOfxActionLoad, nullptr, {}, {});
    }
    ~Plugin() { act(kOfxActionUnload, nullptr, nullptr, nullptr); }
    Plugin(const Plugin &) = delete;
    Plugin &operator=(const Plugin &) = delete;

    OfxStatus act(const char *action, Effect *effect, Properties *in, Properties *out) const {
        return plugin_->mainEntry(action, effect, in ? in->handle() : nullptr, out ? out->handle() : nullptr);
    }
    void require(const char *action, Effect *effect, Properties *in, Properties *out) const {
        const OfxStatus status = act(action, effect, in, out);
        if (status != kOfxStatOK && status != kOfxStatReplyDefault) fail(std::string(action) + " fails");
    }
    Effect described(const std::string &context) const {
        Effect effect;
        require(kOfxActionDescribe, &effect, nullptr, nullptr);
        Properties in;
        in.set<std::string>(kOfxImageEffectPropContext, context);
        require(kOfxImageEffectActionDescribeInContext, &effect, &in, nullptr);
        return effect;
    }

private:
    OfxPlugin *plugin_ = nullptr;
    Properties host_;
};

void print_description(const Plugin &plugin) {
    Effect effect;
    plugin.require(kOfxActionDescribe, &effect, nullptr, nullptr);
    for (const Value &context : effect.properties.values.at(kOfxImageEffectPropSupportedContexts)) {
        const Effect in = plugin.described(std::get<std::string>(context));
        std::printf("context %s:", std::get<std::string>(context).c_str());
        for (const auto &clip : in.clips) std::printf(" %s", clip.first.c_str());
        std::printf("\n");
        for (const std::string &name : in.parameters.order) {
            const Parameter &parameter = *in.parameters.parameters.at(name);
            const auto &values = parameter.properties.values;
            const auto animates = values.find(kOfxParamPropAnimates);
            const bool keyed = animates != values.end() && std::get<int>(animates->second[0]) == 1;
            std::printf("  %s %s%s\n", name.c_str(), parameter.type.c_str(), keyed ? " keyed" : "");
        }
    }
}

void set_parameter(Effect &effect, const std::string &name, const std::string &text) {
    const auto found = effect.parameters.parameters.find(name);
    if (found == effect.parameters.parameters.end()) fail("no parameter " + name);
    Parameter &parameter = *found->second;
    parameter.text = text;
    if (parameter.type == kOfxParamTypeString) return;
    if (parameter.type == kOfxParamTypeChoice) {
        const auto &options = parameter.properties.values.at(kOfxParamPropChoiceOption);
        for (std::size_t i = 0; i < options.size(); ++i)
            if (std::get<std::string>(options[i]) == text) parameter.keys[0] = double(i);
        if (parameter.keys.empty()) fail(name + " has no option " + text);
        return;
    }
    std::istringstream keys(text);
    for (std::string key; std::getline(keys, key, ',');) {
        const std::size_t colon = key.find(':');
        parameter.keys[colon == std::string::npos ? 0 : std::stod(key)] =
            std::stod(colon == std::string::npos ? key : key.substr(colon + 1));
    }
}

// The dof-view that this process has started; 0 if there is none.
int gatherer() {
    for (const auto &entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "stat");
        std::string stat;
        if (!std::getline(file, stat) || stat.find("(dof-view)") == std::string::npos) continue;
        std::istringstream after(stat.substr(stat.rfind(')') + 1));
        std::string state;
        int parent = 0;
        after >> state >> parent;
        if (parent == getpid()) return std::stoi(entry.path().filename());
    }
    return 0;
}

class Render {
public:
    Render(const Plugin &plugin, Effect &effect, const Words &words)
        : plugin_(plugin), effect_(effect), canvas_(canvas_of(words)), time_(words.number("@time", 0)),
          tile_(int(words.number("@tiles", 1 << 20))), threads_(int(words.number("@threads", 1))) {
        for (int i = 0; i < 2; ++i) {
            effect.properties.set<double>(kOfxImageEffectPropProjectOffset, 0, i);
            effect.properties.set<double>(
                kOfxImageEffectPropProjectSize,
                (i == 0 ? canvas_.display_width * canvas_.aspect : canvas_.display_height) / canvas_.scale,
                i);
        }
        connect("Source", words.text("@source", ""), false);
        connect("Depth", words.text("@z", ""), true);
        effect.clips.at("Output")->properties.set<double>(kOfxImagePropPixelAspectRatio, canvas_.aspect);
        Properties preferences;
        plugin.require(kOfxActionCreateInstance, &effect, nullptr, nullptr);
        plugin.require(kOfxImageEffectActionGetClipPreferences, &effect, nullptr, &preferences);
        if (words.yes("@region")) take_region();
        if (!words.text("@source", "").empty()) require_all_of_source();
        output_ = image_of(canvas_);
        effect.clips.at("Output")->image = output_;
    }
    ~Render() { plugin_.act(kOfxActionDestroyInstance, &effect_, nullptr, nullptr); }
    Render(const Render &) = delete;
    Render &operator=(const Render &) = delete;

    // Renders all windows. Returns the status of the last one that failed, or OK.
    OfxStatus run() {
        std::vector<Properties> windows;
        for (int y = canvas_.y1; y < canvas_.y1 + canvas_.height; y += tile_)
            for (int x = canvas_.x1; x < canvas_.x1 + canvas_.width; x += tile_)
                windows.push_back(window_at(x, y));
        std::atomic<std::size_t> next = 0;
        std::atomic<int> status = kOfxStatOK;
        const auto work = [&] {
            for (std::size_t i = next++; i < windows.size(); i = next++)
                if (const OfxStatus one =
                        plugin_.act(kOfxImageEffectActionRender, &effect_, &windows[i], nullptr);
                    one != kOfxStatOK)
                    status = one;
        };
        std::vector<std::thread> others;
        for (int i = 1; i < threads_; ++i) others.emplace_back(work);
        work();
        for (std::thread &thread : others) thread.join();
        return status;
    }
    std::vector<unsigned char> &memory() { return output_->memory; }
    void write(const std::string &file) { write_image(*output_, canvas_, file); }

private:
    void connect(const char *name, const std::string &file, bool is_depth) {
        const auto clip = effect_.clips.find(name);
        if (clip == effect_.clips.end()) return;
        clip->second->properties.set<int>(kOfxImageClipPropConnected, file.empty() ? 0 : 1);
        if (!file.empty()) clip->second->image = read_image(file, canvas_, is_depth);
    }
    Properties at_time() const {
        Properties in;
        in.set<double>(kOfxPropTime, time_);
        for (int i = 0; i < 2; ++i) in.set<double>(kOfxImageEffectPropRenderScale, canvas_.scale, i);
        return in;
    }
    Properties window_at(int x, int y) const {
        Properties in = at_time();
        const int window[] = {x, y, std::min(x + tile_, canvas_.x1 + canvas_.width),
                              std::min(y + tile_, canvas_.y1 + canvas_.height)};
        for (int i = 0; i < 4; ++i) in.set<int>(kOfxImageEffectPropRenderWindow, window[i], i);
        return in;
    }
    void take_region() {
        Properties in = at_time(), out;
        if (plugin_.act(kOfxImageEffectActionGetRegionOfDefinition, &effect_, &in, &out) != kOfxStatOK)
            fail("the effect has no region");
        const auto side = [&](int i) {
            return out.get<double>(kOfxImageEffectPropRegionOfDefinition, i) * canvas_.scale /
                   (i % 2 == 0 ? canvas_.aspect : 1);
        };
        canvas_.x1 = int(std::floor(side(0)));
        canvas_.y1 = int(std::floor(side(1)));
        canvas_.width = int(std::ceil(side(2))) - canvas_.x1;
        canvas_.height = int(std::ceil(side(3))) - canvas_.y1;
    }
    void require_all_of_source() {
        Properties in = at_time(), out;
        plugin_.require(kOfxImageEffectActionGetRegionsOfInterest, &effect_, &in, &out);
        if (out.has("OfxImageClipPropRoI_Source") &&
            out.get<double>("OfxImageClipPropRoI_Source", 2) != canvas_.width)
            fail("the effect needs but a part of its source");
    }

    const Plugin &plugin_;
    Effect &effect_;
    Canvas canvas_;
    double time_;
    int tile_, threads_;
    std::shared_ptr<Image> output_;
};

void kill_often(Render &render, int times) {
    std::minstd_rand random(1);
    const std::vector<unsigned char> expected = render.memory();
    for (int i = 0; i < times; ++i) {
        std::thread killer([process = gatherer(), after = std::chrono::milliseconds(random() % 60)] {
            std::this_thread::sleep_for(after);
            if (process > 0) kill(process, SIGKILL);
        });
        const OfxStatus during = render.run();
        killer.join();
        if (during == kOfxStatOK && render.memory() != expected)
            fail("a killed gatherer changes the picture");
        if (render.run() != kOfxStatOK || render.memory() != expected) fail("the render after a kill fails");
    }
}

void render(const Plugin &plugin, const std::string &context, const std::string &out, const Words &words) {
    Effect effect = plugin.described("OfxImageEffectContext" + context);
    for (const auto &[name, value] : words)
        if (name[0] != '@') set_parameter(effect, name, value);
    Render render(plugin, effect, words);
    OfxStatus status = render.run();
    kill_often(render, int(words.number("@kill", 0)));
    if (const std::string command = words.text("@again", ""); !command.empty()) {
        if (std::system(command.c_str()) != 0) fail(command);
        status = render.run();
    }
    std::printf("status %d\n%s\n", status, messages().last.c_str());
    render.write(out);
}

} // namespace

int main(int count, char **arguments) {
    try {
        Words words;
        for (int i = 5; i < count; ++i) {
            const std::string text = arguments[i];
            words[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
        }
        if (count < 3) fail("usage: ofx-host FILE.ofx describe, or render CONTEXT OUT.exr WORD...");
        const Plugin plugin(arguments[1], words);
        if (std::string(arguments[2]) == "describe")
            print_description(plugin);
        else if (count >= 5)
            render(plugin, arguments[3], arguments[4], words);
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ofx-host: %s\n", error.what());
        return 1;
    }
}
