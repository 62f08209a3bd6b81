// Every pass of a frame, in execution order. One host file per pass, its stem that of its shader, where it has one.
#pragma once
#include "plan/pass.h"

#include <span>

namespace tessera
{

extern const PassDesc kFrameBegin;
extern const PassDesc kInstanceClassify;
extern const PassDesc kClusterCull;
extern const PassDesc kClusterClassify;
extern const PassDesc kTriangleSplit;
extern const PassDesc kRateSearch;
extern const PassDesc kBatchParts;
extern const PassDesc kRateFit;
extern const PassDesc kEvaluateVertices;
extern const PassDesc kRasterSmall;
extern const PassDesc kRasterMicro;
extern const PassDesc kBuildGeometry;
extern const PassDesc kExpandMeshes;
extern const PassDesc kBuildMeshes;
extern const PassDesc kClearClusters;
extern const PassDesc kListClusters;
extern const PassDesc kListStructures;
extern const PassDesc kInsertClusters;
extern const PassDesc kInstantiateClusters;
extern const PassDesc kBuildTransients;
extern const PassDesc kBuildStructures;
extern const PassDesc kPlaceInstances;
extern const PassDesc kBuildScene;
extern const PassDesc kTraceVisibility;
extern const PassDesc kTraceClusters;
extern const PassDesc kDepthPyramid;
extern const PassDesc kMeasureHidden;
extern const PassDesc kRetestParts;
extern const PassDesc kRasterRevealed;
extern const PassDesc kDrawClusters;
extern const PassDesc kDrawBatches;
extern const PassDesc kDrawIndexed;
extern const PassDesc kDumpMicro;
extern const PassDesc kKeepVisibility;
extern const PassDesc kTraceShadows;
extern const PassDesc kTraceAmbient;
extern const PassDesc kShade;

std::span<const PassDesc* const> framePasses();

}  // namespace tessera
