"""Learns to follow the line from pictures with stable-baselines3's PPO, which brings PyTorch:

    pip install "stable-baselines3>=2.3,<3"
    python3 examples/train_ppo.py [--steps 300000] [--processes 2] [--out out/ppo]

OUT.zip is what stable-baselines3 loads again. Gray pictures of 84x84, four in a row.
"""

import argparse
import sys

import gymnasium
from driving_courses.randomisation import TRIALS

import driving_courses  # noqa: F401  (names the environments)

try:
    from stable_baselines3 import PPO
    from stable_baselines3.common.vec_env import SubprocVecEnv, VecFrameStack
except ModuleNotFoundError as error:
    sys.exit(f'train_ppo: {error}; pip install "stable-baselines3>=2.3,<3"')


def make():
    """PPO likes actions from -1 to 1."""
    env = gymnasium.make("driving_courses/LineFollow-v0", size=(84, 84), timestep=0.004,
                         duration=60.0, randomise=TRIALS)
    env = gymnasium.wrappers.GrayscaleObservation(env, keep_dim=True)
    return gymnasium.wrappers.RescaleAction(env, -1.0, 1.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=300_000)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--out", default="out/ppo")
    given = parser.parse_args()
    envs = VecFrameStack(SubprocVecEnv([make] * given.processes, start_method="spawn"), 4)
    model = PPO("CnnPolicy", envs, n_steps=250, batch_size=125, seed=0, verbose=1)
    model.learn(given.steps)
    model.save(given.out)
    envs.close()


if __name__ == "__main__":
    main()
