#include "pipeline/passes.h"

namespace tessera
{

std::span<const PassDesc* const> framePasses()
{
	static constexpr const PassDesc* kPasses[] = {
		&kFrameBegin,  &kInstanceClassify, &kClusterCull,   &kClusterClassify, &kTriangleSplit, &kRateSearch,      &kBatchParts,
		&kRateFit,     &kEvaluateVertices, &kBuildGeometry, &kPlaceInstances,  &kBuildScene,    &kTraceVisibility, &kRasterSmall,
		&kRasterMicro, &kDepthPyramid,     &kRetestParts,   &kRasterRevealed,  &kDrawClusters,  &kDrawBatches,     &kDrawIndexed,
		&kDumpMicro,   &kKeepVisibility,   &kTraceShadows,  &kTraceAmbient,    &kShade,
	};
	return kPasses;
}

}  // namespace tessera
