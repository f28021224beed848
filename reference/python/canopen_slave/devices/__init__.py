"""The devices, by the names of their folders."""

from ..behaviour import Behaviour
from .drive import Drive, SyncingDrive
from .encoder import Encoder
from .gateway import Gateway

DEVICES: dict[str, type[Behaviour]] = {
    "huacheng-ssts1": SyncingDrive,
    "kinco-servo": Drive,
    "liaomiao-encoder": Encoder,
    "teco-jn5-cm-can": Gateway,
}
