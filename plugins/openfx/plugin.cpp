// An OpenFX effect that refocuses LDIs, or flat pictures with their depth: dof-view --pipe makes the pictures
// (docs/openfx.md). It links only the libraries of C and C++, and starts nothing before a picture is asked for.
#include "asked.h"
#include "describe.h"
#include "host.h"
#include "render.h"

#include <cctype>
#include <exception>
#include <new>
#include <string>
#include <string_view>

namespace sparselens_ofx {

namespace {

OfxHost *the_host = nullptr;

void set_host(OfxHost *host) { the_host = host; }

// Messages of dof-gather name options; a host shows parameters: focus distance for --focus-distance.
std::string for_host(const std::string &why) {
    std::string text;
    bool option = false;
    for (std::size_t i = 0; i < why.size(); ++i) {
        const bool begins =
            why.compare(i, 2, "--") == 0 && (i == 0 || !std::isalnum(static_cast<unsigned char>(why[i - 1])));
        if (begins) {
            option = true;
            ++i;
        } else {
            option = option && (why[i] == '-' || std::islower(static_cast<unsigned char>(why[i])));
            text += option && why[i] == '-' ? ' ' : why[i];
        }
    }
    return text;
}

OfxStatus act(std::string_view action, OfxImageEffectHandle effect, OfxPropertySetHandle in,
              OfxPropertySetHandle out) {
    if (action == kOfxActionLoad) return fetch_suites(the_host) ? kOfxStatOK : kOfxStatErrMissingHostFeature;
    if (action == kOfxActionUnload) return stop_asking(), kOfxStatOK;
    if (action == kOfxActionDescribe) return describe(effect), kOfxStatOK;
    if (action == kOfxImageEffectActionDescribeInContext) return describe_in_context(effect, in), kOfxStatOK;
    if (action == kOfxActionCreateInstance || action == kOfxActionDestroyInstance) return kOfxStatOK;
    if (action == kOfxImageEffectActionGetRegionOfDefinition) return region_of_definition(effect, in, out);
    if (action == kOfxImageEffectActionGetRegionsOfInterest) return regions_of_interest(effect, in, out);
    if (action == kOfxImageEffectActionGetClipPreferences) return clip_preferences(effect, out);
    if (action != kOfxImageEffectActionRender) return kOfxStatReplyDefault;
    const OfxStatus status = render(effect, in);
    clear_error(effect);
    return status;
}

// The status that a host receives for an exception. The host chooses a region itself, and the render then tells the
// error.
OfxStatus failed(std::string_view action, OfxImageEffectHandle effect, const std::string &why) {
    if (action == kOfxImageEffectActionGetRegionOfDefinition) return kOfxStatReplyDefault;
    if (action == kOfxImageEffectActionRender) show_error(effect, for_host(why));
    return kOfxStatFailed;
}

OfxStatus main_entry(const char *name, const void *handle, OfxPropertySetHandle in,
                     OfxPropertySetHandle out) {
    const std::string_view action = name;
    const auto effect = static_cast<OfxImageEffectHandle>(const_cast<void *>(handle)); // as OpenFX has it
    try {
        return act(action, effect, in, out);
    } catch (const std::bad_alloc &) {
        return kOfxStatErrMemory;
    } catch (const std::exception &error) {
        return failed(action, effect, error.what());
    } catch (...) {
        return kOfxStatFailed;
    }
}

OfxPlugin plugin{kOfxImageEffectPluginApi, 1, "org.sparselens.DepthOfField", 1, 0, set_host, main_entry};

} // namespace

} // namespace sparselens_ofx

#define SPARSELENS_EXPORT extern "C" __attribute__((visibility("default")))

SPARSELENS_EXPORT int OfxGetNumberOfPlugins(void) { return 1; }
SPARSELENS_EXPORT OfxPlugin *OfxGetPlugin(int nth) { return nth == 0 ? &sparselens_ofx::plugin : nullptr; }
