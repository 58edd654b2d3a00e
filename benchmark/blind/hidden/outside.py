"""Effects that are in no catalogue: whoever names one of it for them is wrong."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale, touching
from benchmark.blind.motion import Array


@dataclass(frozen=True, kw_only=True)
class HiddenFrameResonance(Hidden):
    """The frame rings at `frequency` Hz after each jerk, for a second."""

    slug = "outside_frame_resonance"
    frequency: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """3 to 6 Hz."""
        return cls(scale=scale, frequency=float(rng.uniform(3.0, 6.0)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and ringing."""
        jerk = np.gradient(np.gradient(np.gradient(depth, time), time), time)
        t = np.arange(0.0, 4.0, time[1] - time[0])
        answer = np.exp(-t / 0.8) * np.sin(2 * np.pi * self.frequency * t)
        ring = np.convolve(jerk, answer)[: time.size]
        return force + 0.1 * self.amplitude * self.scale.force * ring / max(float(abs(ring).max()), 1e-30)


@dataclass(frozen=True, kw_only=True)
class HiddenMotorPickUp(Hidden):
    """The motor's current hums into the cable while it moves: a beat of `frequency` Hz, whichever way it moves."""

    slug = "outside_motor_pick_up"
    frequency: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """0.8 to 2 Hz."""
        return cls(scale=scale, frequency=float(rng.uniform(0.8, 2.0)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and hum."""
        moving = np.abs(np.gradient(depth, time)) > 0.02 * self.scale.speed
        hum = np.where(moving, 1.0 + 0.7 * np.sin(2 * np.pi * self.frequency * time), 0.0)
        return force + 0.1 * self.amplitude * self.scale.force * hum


@dataclass(frozen=True, kw_only=True)
class HiddenLeadScrewError(Hidden):
    """The tool runs ahead and behind with each turn of a lead screw of `pitch` m."""

    slug = "outside_lead_screw"
    pitch: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """A pitch of 0.5 to 0.9 mm."""
        return cls(scale=scale, pitch=float(rng.uniform(0.5e-3, 0.9e-3)))

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth with the screw's error."""
        return depth + 0.2 * self.amplitude * self.pitch * np.sin(2 * np.pi * depth / self.pitch)


class HiddenLampHeat(Hidden):
    """A lamp warms the specimen while the tool touches it, which makes it stiffer and stiffer."""

    slug = "outside_lamp_heat"

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra stiffness with the time in contact, squared."""
        contact = np.cumsum(touching(depth, 0.1 * self.scale.shallow)) * (time[1] - time[0])
        stiffer: Array = 0.3 * self.amplitude * (contact / 10.0) ** 2
        return stiffer * elastic


@dataclass(frozen=True, kw_only=True)
class HiddenSwayingCamera(Hidden):
    """The camera's arm swings at `frequency` Hz after the motor has started, the same in each trial."""

    slug = "outside_swaying_camera"
    only_markers = True
    frequency: float
    angle: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Slow swings in any direction."""
        return cls(scale=scale, frequency=float(rng.uniform(0.3, 1.0)), angle=float(rng.uniform(-np.pi, np.pi)))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Everything swings together, at 30 frames a second."""
        frame = np.arange(len(x))[:, None] / 30.0
        swing = 0.2e-3 * self.amplitude * np.exp(-frame / 10.0) * np.sin(2 * np.pi * self.frequency * frame)
        return x + swing * np.cos(self.angle), y + swing * np.sin(self.angle)
