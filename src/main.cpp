#include "app/commands.h"

int main(int argc, char** argv)
{
	return tessera::runProgram({ argv + (argc > 0 ? 1 : 0), argv + argc });
}
