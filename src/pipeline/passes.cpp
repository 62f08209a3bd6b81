#include "pipeline/passes.h"

namespace tessera
{

std::span<const PassDesc* const> framePasses()
{
	static constexpr const PassDesc* kPasses[] = {
		&kFrameBegin,      &kInstanceClassify, &kClusterCull,      &kClusterClassify, &kTriangleSplit,       &kRateSearch,
		&kBatchParts,      &kRateFit,          &kEvaluateVertices, &kBuildGeometry,   &kExpandMeshes,        &kBuildMeshes,
		&kClearClusters,   &kListClusters,     &kListStructures,   &kInsertClusters,  &kInstantiateClusters, &kBuildTransients,
		&kBuildStructures, &kPlaceInstances,   &kBuildScene,       &kTraceVisibility, &kTraceClusters,       &kRasterSmall,
		&kRasterMicro,     &kDepthPyramid,     &kMeasureHidden,    &kRetestParts,     &kRasterRevealed,      &kDrawClusters,
		&kDrawBatches,     &kDrawIndexed,      &kDumpMicro,        &kKeepVisibility,  &kTraceShadows,        &kTraceAmbient,
		&kShade,
	};
	return kPasses;
}

}  // namespace tessera
