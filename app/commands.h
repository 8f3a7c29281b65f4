// The subcommands. Each gets its own name as argv[0] and returns the program's exit code.
#pragma once

namespace trackbed {

int run_command(int argc, char** argv);
int apss_command(int argc, char** argv);
int check_command(int argc, char** argv);
int describe_command(int argc, char** argv);
int bench_command(int argc, char** argv);
int stone_command(int argc, char** argv);
int study_command(int argc, char** argv);
int judge_command(int argc, char** argv);
int couple_command(int argc, char** argv);

}  // namespace trackbed
