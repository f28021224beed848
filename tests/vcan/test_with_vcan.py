"""with-vcan promises what its first lines say; the kernel in it promises what our SocketCAN link is built on.

    python3 tests/vcan/test_with_vcan.py
"""

import os
import pathlib
import signal
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).parent
WITH_VCAN = str(HERE / "with-vcan")


def with_vcan(*command, **environment):
    return subprocess.run(
        [WITH_VCAN, *command], env=os.environ | environment, capture_output=True, text=True, timeout=120
    )


class Runner(unittest.TestCase):
    def test_the_exit_code_is_the_commands(self):
        for code in (0, 3, 127):
            self.assertEqual(with_vcan("sh", "-c", f"exit {code}").returncode, code)

    def test_a_command_that_is_not_there_is_127(self):
        self.assertEqual(with_vcan("no-such-command-anywhere").returncode, 127)

    def test_output_is_the_commands_alone(self):
        done = with_vcan("sh", "-c", "seq 1 200000; echo problem >&2")
        self.assertEqual(done.stdout, "".join(f"{number}\n" for number in range(1, 200001)))
        self.assertEqual(done.stderr, "problem\n")

    def test_arguments_environment_and_directory_arrive(self):
        probe = "import os, sys; print(sys.argv[1:], repr(os.environ['ODD']), os.getcwd(), repr(sys.stdin.read()))"
        done = with_vcan(sys.executable, "-c", probe, 'a "b', "$c", "", ODD="one'\ntwo $x")
        self.assertEqual(done.stdout, f"""['a "b', '$c', ''] "one'\\ntwo $x" {os.getcwd()} ''\n""")

    def test_the_time_is_limited(self):
        done = with_vcan("sleep", "1000", VCAN_TIMEOUT="5")
        self.assertEqual(done.returncode, 124)
        self.assertIn("VCAN_TIMEOUT", done.stderr)

    def test_an_interrupt_ends_it_and_leaves_nothing(self):
        process = subprocess.Popen(
            [WITH_VCAN, "sh", "-c", "echo started; exec sleep 1000"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self.assertEqual(process.stdout.readline(), b"started\n")
        before = set(pathlib.Path("/tmp").glob("with-vcan.*"))
        os.killpg(process.pid, signal.SIGINT)
        # Ends only when every process that holds our ends of the pipes is gone.
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130)
        self.assertFalse([folder for folder in before if folder.exists()])

    def test_what_the_command_leaves_running_does_not_hold_it_up(self):
        self.assertEqual(with_vcan("sh", "-c", "sleep 1000 & exit 4", VCAN_KERNEL="uml").returncode, 4)

    def test_a_kernel_with_can_is_used_itself_and_left_as_it_was(self):
        names = "echo $(ls /sys/class/net)"
        inner = f"VCAN_KERNEL=host VCAN_INTERFACES='vcan0 vcan7' '{WITH_VCAN}' sh -c '{names}; exit 6'"
        done = with_vcan("sh", "-c", f"{names}; {inner}; echo $?; {names}")
        before, inside, code, after = done.stdout.splitlines()
        self.assertEqual(before, after)
        self.assertEqual(set(before.split()) | {"vcan7"}, set(inside.split()))
        self.assertEqual(code, "6")


class Kernel(unittest.TestCase):
    def test_buses_and_pseudo_terminals(self):
        done = with_vcan(sys.executable, str(HERE / "kernel_facts.py"))
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
