// Renderers of one device share pipelines.
#include "gpu/pipeline_store.h"
#include "gpu_test.h"

namespace tessera::test
{

using pipelineStore = GpuTest;

namespace
{

Shader shaderOf(std::string_view name)
{
	auto shader = loadShader(name);
	EXPECT_TRUE(shader) << (shader ? "" : shader.error().message);
	return shader ? *shader : Shader();
}

}  // namespace

TEST_F(pipelineStore, aRendererLikeOneThatIsGoneMakesNone)
{
	const auto scene = gpuScene("quad");
	const std::vector<uint8_t> first = drawFrame(*scene, smallOptions(8)).picture();
	const size_t made = gpu().pipelines->size();
	EXPECT_GT(made, 0u);
	EXPECT_EQ(drawFrame(*scene, smallOptions(8)).picture(), first);
	EXPECT_EQ(gpu().pipelines->size(), made);
}

TEST_F(pipelineStore, otherCodeConstantsOrStateAreOtherPipelines)
{
	auto store = PipelineStore::create(gpu());
	ASSERT_TRUE(store);
	const Shader shader = shaderOf("culling/instance_classify.comp");
	const auto get = [&](const Shader& code, const Constants& constants) {
		auto pipeline = (*store)->get(code, constants);
		EXPECT_TRUE(pipeline);
		return pipeline ? *pipeline : nullptr;
	};
	const auto one = get(shader, { { 0, 32 } });
	EXPECT_EQ(get(shader, { { 0, 32 } }), one);
	EXPECT_NE(get(shader, { { 0, 64 } }), one);
	Shader changed = shaderOf("culling/frame_begin.comp");
	changed.name = shader.name;
	EXPECT_NE(get(changed, { { 0, 32 } }), one) << "shaders of one name may change while the program runs";
	EXPECT_EQ((*store)->size(), 3u);
}

TEST_F(pipelineStore, whatNobodyUsesIsKeptUpToANumber)
{
	auto store = PipelineStore::create(gpu());
	ASSERT_TRUE(store);
	const Shader shader = shaderOf("culling/frame_begin.comp");
	const auto used = (*store)->get(shader, { { 1000, 0 } });
	ASSERT_TRUE(used);
	const auto* const last = &**used;
	for (uint32_t i = 1; i <= PipelineStore::kMostUnused + 20; ++i)
		ASSERT_TRUE((*store)->get(shader, { { 1000, i } })) << "a constant that the shader does not read makes another key";
	EXPECT_LE((*store)->size(), PipelineStore::kMostUnused + 2);
	const auto again = (*store)->get(shader, { { 1000, 0 } });
	ASSERT_TRUE(again);
	EXPECT_EQ(&**again, last) << "what is in use stays";
}

}  // namespace tessera::test
