"""Finds the values of arrays on a CUDA device, from any library that has DLPack or __cuda_array_interface__."""

from __future__ import annotations

import ctypes
import operator
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy
from numpy.typing import NDArray

from .errors import UsageError

#: DLPack's numbers of device types.
_HOST = (1, 3)  #: host memory, page-locked host memory
_CUDA = (2, 13)  #: device memory, managed memory

#: The stream passed to __dlpack__: CUDA's legacy default stream, which then waits for the work that makes the values.
_DEFAULT_STREAM = 1

#: Exceptions that occur if the answer of an array's protocol does not have the form that the protocol prescribes.
_NOT_AS_SAID = (AttributeError, IndexError, KeyError, TypeError, ValueError)

#: DLPack's codes of value types.
_KINDS = {0: "int", 1: "uint", 2: "float", 4: "bfloat", 6: "bool"}


@dataclass(frozen=True)
class DeviceArray:
    """An array in device memory. `owner` keeps the memory allocated."""

    address: int
    type: str  #: numpy's name of the value type, or "bfloat16"
    shape: tuple[int, ...]
    strides: tuple[int, ...]  #: bytes
    stream: Optional[int]  #: its work must end before the values are read; None: nothing to wait for
    owner: Any


def is_array_elsewhere(source: Any) -> bool:
    """Returns whether `source` has DLPack or __cuda_array_interface__."""
    return hasattr(source, "__dlpack_device__") or hasattr(source, "__cuda_array_interface__")


def array_of(source: Any) -> Union[DeviceArray, NDArray[Any]]:
    """Returns the values of an array for which is_array_elsewhere() holds: a DeviceArray, or a numpy array if they
    are in host memory. Copies nothing. Raises UsageError."""
    if not hasattr(source, "__dlpack_device__"):
        return _of_interface(source, source.__cuda_array_interface__)
    try:
        kind = int(source.__dlpack_device__()[0])
    except (RuntimeError, *_NOT_AS_SAID) as error:
        raise UsageError(f"source does not say where its values lie ({error}); give it as a numpy array") from None
    if kind in _HOST:
        try:
            return numpy.from_dlpack(source)
        except (BufferError, RuntimeError, *_NOT_AS_SAID) as error:
            raise UsageError(f"source has values that numpy does not read ({error}); convert them to float32 first") from None
    if kind not in _CUDA:
        raise UsageError(f"source lies on a device of DLPack's kind {kind}; copy it to the host first")
    return _of_dlpack(source)


def _of_interface(source: Any, interface: dict[str, Any]) -> DeviceArray:
    try:
        masked = interface.get("mask") is not None
        stored = numpy.dtype(interface["typestr"])
        shape = _whole_numbers(interface["shape"])
        strides = _whole_numbers(interface.get("strides") or _packed(shape, stored.itemsize))
        address = operator.index(interface["data"][0])
        stream = interface.get("stream") if interface.get("version", 0) >= 3 else _DEFAULT_STREAM
        if len(strides) != len(shape) or not 0 <= address < 1 << 64 or not isinstance(stream, (int, type(None))):
            raise ValueError(f"shape {shape}, strides {strides}, address {address}, stream {stream!r}")
    except _NOT_AS_SAID as error:
        reason = f"it lacks {error}" if isinstance(error, KeyError) else str(error)
        raise UsageError(
            f"source has a __cuda_array_interface__ that is none ({reason}); it has shape, typestr, data and version"
        ) from None
    if masked:
        raise UsageError("source is a masked array; fill it, and give missing=VALUE and missing_policy")
    if not stored.isnative:
        raise UsageError(f"source has the other byte order ({stored.str}); give it in this machine's")
    return DeviceArray(address, stored.name, shape, strides, stream, source)


def _whole_numbers(numbers: Any) -> tuple[int, ...]:
    return tuple(map(operator.index, numbers))


# dlpack.h, https://dmlc.github.io/dlpack/latest/c_api.html
class _DLDevice(ctypes.Structure):
    _fields_ = [("device_type", ctypes.c_int32), ("device_id", ctypes.c_int32)]


class _DLDataType(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint8), ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16)]


class _DLTensor(ctypes.Structure):
    _fields_ = [
        ("data", ctypes.c_void_p),
        ("device", _DLDevice),
        ("ndim", ctypes.c_int32),
        ("dtype", _DLDataType),
        ("shape", ctypes.POINTER(ctypes.c_int64)),
        ("strides", ctypes.POINTER(ctypes.c_int64)),
        ("byte_offset", ctypes.c_uint64),
    ]


def _of_dlpack(source: Any) -> DeviceArray:
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype = ctypes.c_void_p
    pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    try:
        capsule = source.__dlpack__(stream=_DEFAULT_STREAM)
        address = pointer(capsule, b"dltensor")
    except (BufferError, RuntimeError, *_NOT_AS_SAID) as error:
        raise UsageError(f"source does not give its values ({error})") from None
    tensor = _DLTensor.from_address(address)  # a DLManagedTensor begins with it
    shape = tuple(tensor.shape[i] for i in range(tensor.ndim))
    if tensor.dtype.lanes != 1:
        raise UsageError(f"source has values of {tensor.dtype.lanes} components; give one of them")
    kind = _KINDS.get(tensor.dtype.code, f"DLPack's type {tensor.dtype.code} of ")
    size = tensor.dtype.bits // 8
    strides = tuple(size * tensor.strides[i] for i in range(tensor.ndim)) if tensor.strides else _packed(shape, size)
    name = kind if kind == "bool" else f"{kind}{tensor.dtype.bits}"
    # The capsule is not consumed, so its own destructor releases the values.
    return DeviceArray((tensor.data or 0) + tensor.byte_offset, name, shape, strides, _DEFAULT_STREAM, capsule)


def _packed(shape: tuple[int, ...], size: int) -> tuple[int, ...]:
    strides = []
    for extent in reversed(shape):
        strides.append(size)
        size *= extent
    return tuple(reversed(strides))
