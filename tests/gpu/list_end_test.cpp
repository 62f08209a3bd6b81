// Lists that are told to end early: what lies behind their end must stay as it was, whoever appends.
#include "gpu_test.h"

#include "frame/pass_runner.h"
#include "pipeline/passes.h"

#include <algorithm>

namespace tessera::test
{

namespace
{

using listEnd = GpuTest;

constexpr uint32_t kUntouched = 0xcdcdcdcd;

#define ASSERT_FINE(expression) ASSERT_TRUE((expression).has_value())

// What a frame left behind.
struct EndedEarly
{
	std::vector<uint32_t> words;  // of the whole list buffer
	ListHead head = {};
	bool overflow = false;
};

// Runs the plan of `frame` once more on resources of its own, where `list` says that it holds only `capacity` entries although its
// buffer is as large as ever.
void runWithCapacity(const GpuFrame& frame, const ListDesc& list, uint32_t capacity, EndedEarly& result)
{
	const PlanInput& input = frame.renderer->planInput();
	const FramePlan& plan = frame.renderer->plan();
	auto resources = FrameResources::create(gpu(), frame.scene.built, frame.scene.table, input);
	ASSERT_FINE(resources);
	FrameResources& r = **resources;
	ASSERT_FINE(r.prepare(plan, input));
	auto runner = PassRunner::create(gpu(), r);
	ASSERT_FINE(runner);
	ASSERT_FINE((*runner)->preparePipelines(plan, input));

	ASSERT_FINE(r.commands().begin());
	const VkCommandBuffer commands = r.commands().buffer();
	vkCmdFillBuffer(commands, r.buffer(list.name).handle(), 0, VK_WHOLE_SIZE, kUntouched);
	vkCmdUpdateBuffer(commands, r.buffer("heads").handle(), r.headOffset(list.name) + offsetof(ListHead, capacity), sizeof capacity, &capacity);
	fullBarrier(commands);
	ASSERT_FINE(r.writeView(frame.view(), 0, false));
	ASSERT_FINE((*runner)->record(plan, input));
	r.recordCountsReadback(commands);
	ASSERT_FINE(r.commands().submitAndWait());
	result.head = r.head(list.index);
	result.overflow = r.counts().overflow != 0;

	const auto bytes = r.read(list.name, UINT64_MAX);
	ASSERT_FINE(bytes);
	result.words.resize(bytes->size() / sizeof(uint32_t));
	std::memcpy(result.words.data(), bytes->data(), result.words.size() * sizeof(uint32_t));
}

void expectUntouchedBehindEveryEnd(const GpuFrame& frame, const std::string& what)
{
	size_t lists = 0;
	for (const ListDesc& list : listDescs())
	{
		if (!frame.renderer->plan().keeps(list.name) || frame.list(list.name).wanted < 2)
			continue;
		const auto capacity = uint32_t(frame.list(list.name).wanted / 2);
		const std::string name = fmt::format("{}: {} of {}", what, list.name, capacity);
		EndedEarly ended;
		runWithCapacity(frame, list, capacity, ended);
		ASSERT_FALSE(ended.words.empty()) << name;
		const size_t end = size_t(capacity) * list.record_bytes / sizeof(uint32_t);
		ASSERT_LT(end, ended.words.size()) << name;
		EXPECT_TRUE(ended.overflow) << name;
		EXPECT_GT(ended.head.wanted, capacity) << name;
		EXPECT_EQ(ended.head.capacity, capacity) << name;
		EXPECT_EQ(ended.head.peak_used, 0u) << name << ": an attempt that does not fit is not drawn";
		EXPECT_EQ(ended.head.group_rows, 0u) << name;
		const auto touched = std::find_if(ended.words.begin() + long(end), ended.words.end(), [](uint32_t word) { return word != kUntouched; });
		EXPECT_TRUE(touched == ended.words.end()) << name << ": word " << touched - ended.words.begin() << " was written";
		// Lists that decide whether the frame fits are filled; vertices and indices are then left alone altogether.
		const auto filled = std::count(ended.words.begin(), ended.words.begin() + long(end), kUntouched);
		EXPECT_EQ(filled, growsOnDemand(list) ? long(end) : 0) << name;
		++lists;
	}
	EXPECT_GE(lists, 3u) << what;
}

}  // namespace

TEST_F(listEnd, nothingIsWrittenBehindTheEndOfAnyList)
{
	const auto boulders = gpuScene("instances:150"), cube = gpuScene("cube");
	for (const Raster path : rasterPaths())
	{
		RenderOptions options = smallOptions(5);
		options.raster = path;
		options.cull = { false, false, false };
		expectUntouchedBehindEveryEnd(drawFrame(*boulders, options), fmt::format("boulders, raster {}", int(path)));
		options.rate = 2;
		const GpuFrame split = drawFrame(*cube, options, closeTo(*cube, 0.5));
		EXPECT_GT(split.result.counts.split_triangles, 1u);
		expectUntouchedBehindEveryEnd(split, fmt::format("cube, raster {}", int(path)));
		options.rate = 0;
		expectUntouchedBehindEveryEnd(drawFrame(*boulders, options), fmt::format("untessellated boulders, raster {}", int(path)));
	}
}

}  // namespace tessera::test
