// The program's exit codes and messages where no device is needed.
#include "base/file.h"
#include "program_run.h"
#include "scene/builtin.h"
#include "scene/gltf_import.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessera::test
{

namespace
{

void expectRefused(const std::string& arguments, int exit_code, const std::string& part)
{
	const ProgramRun run = runTessera(arguments + " --quiet");
	EXPECT_EQ(run.exit_code, exit_code) << arguments << "\n" << run.errors;
	EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
	EXPECT_EQ(run.errors.rfind("tessera: error: ", 0), 0u) << run.errors;
	EXPECT_NE(run.errors.find(part), std::string::npos) << part << " is not in: " << run.errors;
	EXPECT_EQ(run.output, "");
	EXPECT_FALSE(std::filesystem::exists(scratchFolder() / "tessera.png"));
}

}  // namespace

TEST(program, wrongUsageEndsWithTwo)
{
	expectRefused("draw", 2, "render, report, export, info");
	expectRefused("render --rate fast", 2, "--rate fast");
	expectRefused("render --bogus", 2, "--bogus");
	expectRefused("render --raster voxels", 2, "mesh, indexed");
	expectRefused("render -o picture.jpg", 2, "picture.jpg");
	expectRefused("render builtin:quad --camera 9", 2, "--camera 9");
	expectRefused("render --capacity part_triangles=0", 2, "part_triangles can hold from 1");
	expectRefused("render builtin:quad --cluster-size 2x64", 2, "--cluster-size 2x64");
	expectRefused("export builtin:quad -o quad.obj", 2, ".glb or .ply");
	expectRefused("export builtin:quad --base -o quad.ply", 2, ".glb");
	expectRefused("export builtin:quad --base", 2, "-o");
}

TEST(program, badInputEndsWithThree)
{
	ASSERT_TRUE(writeFile(scratchFolder() / "broken.gltf", std::string_view("{ \"asset\": ")));
	ASSERT_TRUE(writeFile(scratchFolder() / "broken.glb", std::string_view("glTF")));
	ASSERT_TRUE(writeFile(scratchFolder() / "broken.table", std::string_view("x")));
	expectRefused("render missing.glb", 3, "missing.glb");
	expectRefused("render broken.gltf", 3, "broken.gltf");
	expectRefused("render broken.glb", 3, "broken.glb");
	expectRefused("render builtin:nothing", 3, "planet");
	expectRefused("render builtin:quad --displacement missing.png", 3, "missing.png");
	expectRefused("render builtin:quad --table broken.table", 3, "broken.table");
	expectRefused("info missing.glb", 3, "missing.glb");
	expectRefused("export missing.glb --base -o a.glb", 3, "missing.glb");
}

TEST(program, messagesStayOneLineWhateverTheyQuote)
{
	expectRefused("render \"$(printf 'a\\nb')\"", 3, "a b");
}

TEST(program, helpAndVersionGoToStandardOutput)
{
	for (const char* arguments : { "--help", "--version", "render --help", "info -h" })
	{
		const ProgramRun run = runTessera(arguments);
		EXPECT_EQ(run.exit_code, 0) << arguments;
		EXPECT_NE(run.output, "") << arguments;
		EXPECT_EQ(run.errors, "") << arguments;
	}
}

TEST(program, anExportedSceneIsTheSceneAgain)
{
	ASSERT_EQ(runTessera("export builtin:cube --base -o cube.glb --grid 2x1").exit_code, 0);
	const Result<ImportedScene> made = makeBuiltinScene("cube"), read = importGltf(scratchFolder() / "cube.glb");
	ASSERT_TRUE(made && read);
	EXPECT_EQ(read->instances.size(), 2 * made->instances.size());
	ASSERT_EQ(read->meshes.size(), made->meshes.size());
	EXPECT_EQ(read->meshes[0].primitives[0].positions, made->meshes[0].primitives[0].positions);
	EXPECT_EQ(read->meshes[0].primitives[0].indices, made->meshes[0].primitives[0].indices);
	EXPECT_TRUE(read->materials[0].displacement);
}

}  // namespace tessera::test
