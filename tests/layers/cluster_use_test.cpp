// How the extension is switched on and used: pipelines, shaders, command buffers.
#include "layers/cluster_mistakes.h"
#include "layers/cluster_tracer.h"
#include "layers/layer_report.h"

#include <gtest/gtest.h>

namespace tessera::test
{

namespace
{

void traceWith(Stage& stage, const TraceOptions& options, const char* closest_hit = "cluster.rchit")
{
	ClusterCommand bottom = stage.bottomLevels(stage.built());
	bottom.run();
	const auto scene = topLevel(stage.gpu, std::vector{ placed(bottom.resultAddresses()[0], 0.0f, 0.0f, 1) });
	trace(stage.gpu, *scene, closest_hit, 4.0f, 8, options);
}

VkCommandBuffer allocate(Gpu& gpu, VkCommandBufferLevel level)
{
	const VkCommandBufferAllocateInfo info = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, gpu.pool, level, 1 };
	VkCommandBuffer commands = VK_NULL_HANDLE;
	EXPECT_VK(vkAllocateCommandBuffers(gpu.device, &info, &commands));
	return commands;
}

}  // namespace

TEST(clusterLayer, aFeatureThatIsOffIsNamed)
{
	const LayerReport report = underTheLayer([](Gpu& gpu) { Stage(gpu).clusters().run(); }, false);
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_TRUE(report.violations.contains("feature-off"));
}

namespace
{

// A cluster's build and its use in one command buffer, with or without a barrier between them.
Mistake buildAndUse(bool barrier, bool share_scratch)
{
	return [=](Stage& stage) {
		ClusterCommand clusters = stage.clusters(), again = stage.clusters(), bottom = stage.bottomLevels(clusters.resultAddresses());
		// Its list is written by the first command.
		argument<BottomLevelInfo>(bottom).clusterReferences = clusters.addresses->address;
		if (share_scratch)
			again.info.scratchData = clusters.info.scratchData;
		stage.gpu.run([&](VkCommandBuffer commands) {
			clusters.record(commands);
			if (barrier)
				fullBarrier(commands);
			share_scratch ? again.record(commands) : bottom.record(commands);
		});
	};
}

}  // namespace

TEST(clusterLayerNames, aMissingBarrierBeforeABottomLevel)
{
	expectNamed("missing-barrier", buildAndUse(false, false));
}

TEST(clusterLayerNames, aMissingBarrierBetweenCommandsThatShareScratch)
{
	expectNamed("missing-barrier", buildAndUse(false, true));
}

TEST(clusterLayerNames, aBarrierThatIsThereIsNotMissed)
{
	for (const bool share_scratch : { false, true })
	{
		const LayerReport report = underTheLayer([&](Gpu& gpu) {
			Stage stage(gpu);
			buildAndUse(true, share_scratch)(stage);
		});
		EXPECT_TRUE(report.violations.empty());
	}
}

TEST(clusterLayerNames, aPipelineThatDoesNotAllowClusters)
{
	expectNamed("pipeline-without-clusters", [](Stage& stage) {
		// A scene without clusters is alive as well, which may be what such a pipeline is for.
		const auto plain = topLevel(stage.gpu, std::vector{ placed(0, 0.0f, 0.0f, 0) });
		traceWith(stage, { .allow_clusters = false });
	});
}

TEST(clusterLayerNames, raysThatMeetClustersByAPipelineThatDoesNotAllowThem)
{
	expectNamed("trace-without-clusters", [](Stage& stage) { traceWith(stage, { .allow_clusters = false }, "plain.rchit"); });
}

TEST(clusterLayerNames, aShaderWithoutTheCapability)
{
	expectNamed("shader-capability", [](Stage& stage) { traceWith(stage, { .say_capability = false }); });
}

TEST(clusterLayer, aSecondaryCommandBufferIsALimit)
{
	const LayerReport report = underTheLayer([](Gpu& gpu) {
		Stage stage(gpu);
		ClusterCommand command = stage.clusters();
		const VkCommandBuffer secondary = allocate(gpu, VK_COMMAND_BUFFER_LEVEL_SECONDARY);
		const VkCommandBufferInheritanceInfo inherited = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO };
		const VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, &inherited };
		EXPECT_VK(vkBeginCommandBuffer(secondary, &begin));
		command.record(secondary);
		EXPECT_VK(vkEndCommandBuffer(secondary));
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_TRUE(report.violations.empty());
	EXPECT_EQ(report.limits.at("limit-segment"), 1u);
}

TEST(clusterLayer, aCommandBufferMayBeSubmittedTwiceAndRecordedAnew)
{
	const LayerReport report = underTheLayer([](Gpu& gpu) {
		Stage stage(gpu);
		ClusterCommand command = stage.clusters();
		const VkCommandBuffer commands = allocate(gpu, VK_COMMAND_BUFFER_LEVEL_PRIMARY);
		const VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
		for (uint32_t round = 0; round < 2; ++round)
		{
			EXPECT_VK(vkResetCommandPool(gpu.device, gpu.pool, 0));
			EXPECT_VK(vkBeginCommandBuffer(commands, &begin));
			command.record(commands);
			fullBarrier(commands);
			vkCmdFillBuffer(commands, command.addresses->handle, 0, 8, round);
			fullBarrier(commands);
			command.record(commands);
			EXPECT_VK(vkEndCommandBuffer(commands));
			for (uint32_t again = 0; again < 2; ++again)
			{
				std::memset(command.addresses->data, 0, 8);
				VkSubmitInfo submit = { VK_STRUCTURE_TYPE_SUBMIT_INFO };
				submit.commandBufferCount = 1;
				submit.pCommandBuffers = &commands;
				EXPECT_VK(vkQueueSubmit(gpu.queue, 1, &submit, VK_NULL_HANDLE));
				EXPECT_VK(vkQueueWaitIdle(gpu.queue));
				EXPECT_EQ(command.resultAddresses()[0], alignedStart(*command.results));
			}
		}
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_TRUE(report.violations.empty());
	EXPECT_EQ(report.counts.at("commands"), 8u);
}

TEST(clusterLayer, semaphoresOfASubmissionAreWaitedForAndSignalled)
{
	const LayerReport report = underTheLayer([](Gpu& gpu) {
		Stage stage(gpu);
		ClusterCommand first = stage.clusters(), second = stage.clusters();
		const VkSemaphoreCreateInfo of = { VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
		VkSemaphore between = VK_NULL_HANDLE;
		EXPECT_VK(vkCreateSemaphore(gpu.device, &of, nullptr, &between));
		const VkCommandBuffer buffers[] = { allocate(gpu, VK_COMMAND_BUFFER_LEVEL_PRIMARY), allocate(gpu, VK_COMMAND_BUFFER_LEVEL_PRIMARY) };
		const VkCommandBufferBeginInfo begin = { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
		for (uint32_t i = 0; i < 2; ++i)
		{
			EXPECT_VK(vkBeginCommandBuffer(buffers[i], &begin));
			(i == 0 ? first : second).record(buffers[i]);
			EXPECT_VK(vkEndCommandBuffer(buffers[i]));
		}
		const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
		const VkSubmitInfo submits[] = {
			{ VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &buffers[0], 1, &between },
			{ VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 1, &between, &stages, 1, &buffers[1], 0, nullptr },
		};
		EXPECT_VK(vkQueueSubmit(gpu.queue, 2, submits, VK_NULL_HANDLE));
		EXPECT_VK(vkQueueWaitIdle(gpu.queue));
		EXPECT_NE(first.resultAddresses()[0], 0u);
		EXPECT_NE(second.resultAddresses()[0], 0u);
		vkDestroySemaphore(gpu.device, between, nullptr);
	});
	if (!report.device)
		GTEST_SKIP() << "the device cannot trace rays";
	EXPECT_TRUE(report.violations.empty());
}

}  // namespace tessera::test
