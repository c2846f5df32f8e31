#include "bench/commands/program.h"

int main(int argc, char** argv) { return boxwood::bench::run_program(argc, argv); }
