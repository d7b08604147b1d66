// The tracer's queries for Embree 3 and 4, which have different interfaces. CMake says which version is installed.
#pragma once

#if SPARSELENS_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace sparselens::lab {

#if SPARSELENS_EMBREE == 3

using QueryContext = RTCIntersectContext;
inline constexpr RTCSceneFlags filtered_scene = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void init_context(QueryContext &context) { rtcInitIntersectContext(&context); }

inline void intersect_coherent(const int *valid, RTCScene scene, RTCRayHit16 &rays) {
    QueryContext context;
    init_context(context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, &rays);
}

inline void find_occluded(const int *valid, RTCScene scene, RTCRay16 &rays) {
    QueryContext context;
    init_context(context);
    rtcOccluded16(valid, scene, &context, &rays);
}

// Calls `filter` for each hit, with `context` in its arguments, which the caller has initialised.
inline void intersect_filtered(RTCScene scene, QueryContext &context, RTCFilterFunctionN filter,
                               RTCRayHit &ray) {
    context.filter = filter;
    rtcIntersect1(scene, &context, &ray);
}

#else

using QueryContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags filtered_scene = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

inline void init_context(QueryContext &context) { rtcInitRayQueryContext(&context); }

inline void intersect_coherent(const int *valid, RTCScene scene, RTCRayHit16 &rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &rays, &arguments);
}

inline void find_occluded(const int *valid, RTCScene scene, RTCRay16 &rays) {
    rtcOccluded16(valid, scene, &rays);
}

// Calls `filter` for each hit, with `context` in its arguments, which the caller has initialised.
inline void intersect_filtered(RTCScene scene, QueryContext &context, RTCFilterFunctionN filter,
                               RTCRayHit &ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    arguments.context = &context;
    arguments.filter = filter;
    rtcIntersect1(scene, &ray, &arguments);
}

#endif

} // namespace sparselens::lab
