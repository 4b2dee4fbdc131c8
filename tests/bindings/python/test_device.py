"""Tests weir.convert of other libraries' arrays: where the values lie, and files of arrays on a CUDA device."""

import ctypes
import unittest
import unittest.mock

import numpy

import weir
from support import FolderTest, noise
from weir.device import DeviceArray, array_of

_DL_NAMES = {"i": 0, "u": 1, "f": 2, "b": 6}


class HostTensor:
    """A stand-in for another library's array in host memory; holds a numpy array."""

    def __init__(self, values):
        self._values = values

    def __dlpack__(self, stream=None):
        return self._values.__dlpack__()

    def __dlpack_device__(self):
        return self._values.__dlpack_device__()


class Tensor:
    """A stand-in for another library's array with DLPack: values at an address."""

    def __init__(self, address, shape, strides, code, bits, lanes=1, device=(2, 0), offset=0):
        self._device = device
        self.streams = []
        self._shape = (ctypes.c_int64 * len(shape))(*shape)
        self._strides = None if strides is None else (ctypes.c_int64 * len(strides))(*strides)
        # DLManagedTensor: data, device, ndim, type, shape, strides, byte_offset, context, deleter
        self._fields = (ctypes.c_uint64 * 8)()
        memory = ctypes.addressof(self._fields)
        ctypes.c_uint64.from_address(memory).value = address
        ctypes.c_int32.from_address(memory + 8).value = device[0]
        ctypes.c_int32.from_address(memory + 12).value = device[1]
        ctypes.c_int32.from_address(memory + 16).value = len(shape)
        ctypes.c_uint8.from_address(memory + 20).value = code
        ctypes.c_uint8.from_address(memory + 21).value = bits
        ctypes.c_uint16.from_address(memory + 22).value = lanes
        ctypes.c_uint64.from_address(memory + 24).value = ctypes.addressof(self._shape)
        ctypes.c_uint64.from_address(memory + 32).value = 0 if strides is None else ctypes.addressof(self._strides)
        ctypes.c_uint64.from_address(memory + 40).value = offset

    def __dlpack_device__(self):
        return self._device

    def __dlpack__(self, stream=None):
        self.streams.append(stream)
        make = ctypes.pythonapi.PyCapsule_New
        make.restype = ctypes.py_object
        make.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
        return make(ctypes.addressof(self._fields), b"dltensor", None)


class Interface:
    """A stand-in for another library's array with __cuda_array_interface__: values at an address."""

    def __init__(self, address, shape, typestr, **others):
        self.__cuda_array_interface__ = {
            "data": (address, False), "shape": shape, "typestr": typestr, "version": 3, **others,
        }


class WhereValuesLie(FolderTest):
    def refusal(self, source):
        with self.assertRaises(weir.UsageError) as raised:
            weir.convert(source, self.folder / "a.nvdb")
        self.assertEqual(self.names(), [])
        return str(raised.exception)

    def test_a_tensor_in_the_hosts_memory_is_one_of_numpys(self):
        values = noise((40, 30, 50), numpy.float32)
        weir.convert(values, self.folder / "numpy.nvdb", lossless=True)
        weir.convert(HostTensor(values), self.folder / "tensor.nvdb", lossless=True)
        self.assertEqual((self.folder / "tensor.nvdb").read_bytes(), (self.folder / "numpy.nvdb").read_bytes())

    def test_a_tensor_of_complex_values_in_the_hosts_memory_is_refused(self):
        self.assertIn("source is of complex64, it must be one of bool, uint8",
                      self.refusal(HostTensor(numpy.zeros((9, 9, 9), numpy.complex64))))

    def test_dlpack_says_address_type_and_strides(self):
        tensor = Tensor(4096, (5, 6, 7), (84, 14, 2), 4, 16, offset=64)
        found = array_of(tensor)
        self.assertEqual(found, DeviceArray(4160, "bfloat16", (5, 6, 7), (168, 28, 4), 1, found.owner))
        self.assertEqual(tensor.streams, [1])
        found = array_of(Tensor(4096, (5, 6, 7), None, 2, 64, device=(13, 0)))
        self.assertEqual((found.type, found.strides), ("float64", (336, 56, 8)))
        found = array_of(Tensor(4096, (5, 6, 7), None, 6, 8))
        self.assertEqual((found.type, found.strides), ("bool", (42, 7, 1)))

    def test_the_interface_says_address_type_strides_and_stream(self):
        self.assertEqual(
            array_of(Interface(512, (5, 6, 7), "<i2", strides=(200, 20, 2), stream=7)),
            DeviceArray(512, "int16", (5, 6, 7), (200, 20, 2), 7, unittest.mock.ANY),
        )
        self.assertEqual(array_of(Interface(512, (5, 6, 7), "<f4", strides=None, stream=None)).strides, (168, 28, 4))
        self.assertIsNone(array_of(Interface(512, (5, 6, 7), "<f4", stream=None)).stream)
        self.assertEqual(array_of(Interface(512, (5, 6, 7), "<f4", version=2)).stream, 1)

    def test_what_is_no_volume_of_scalars_is_refused(self):
        self.assertEqual(
            self.refusal(Tensor(4096, (5, 6, 7), None, 2, 32, device=(10, 0))),
            "source lies on a device of DLPack's kind 10; copy it to the host first",
        )
        self.assertEqual(
            self.refusal(Tensor(4096, (5, 6, 7), None, 2, 32, lanes=4)),
            "source has values of 4 components; give one of them",
        )
        self.assertEqual(
            self.refusal(Tensor(4096, (5, 6), None, 2, 32)), "source has 2 axes, it must have three: [z, y, x]"
        )
        self.assertIn("source is of DLPack's type 5 of 64, it must be one of bool, uint8",
                      self.refusal(Tensor(4096, (5, 6, 7), None, 5, 64)))
        self.assertEqual(
            self.refusal(Interface(512, (5, 6, 7), "<f4", mask=1)),
            "source is a masked array; fill it, and give missing=VALUE and missing_policy",
        )
        self.assertEqual(
            self.refusal(Interface(512, (5, 6, 7), ">f4")),
            "source has the other byte order (>f4); give it in this machine's",
        )

    def test_answers_of_another_form_than_the_protocols_are_refused(self):
        broken = Interface(512, (5, 6, 7), "<f4")
        del broken.__cuda_array_interface__["typestr"]
        end = "; it has shape, typestr, data and version"
        self.assertEqual(
            self.refusal(broken), "source has a __cuda_array_interface__ that is none (it lacks 'typestr')" + end
        )
        self.assertEqual(
            self.refusal(Interface(512, (5, 6, 7), "<f4", strides=(4, 4))),
            "source has a __cuda_array_interface__ that is none (shape (5, 6, 7), strides (4, 4), address 512, stream None)"
            + end,
        )
        for interface in (Interface(512, ("a", 6, 7), "<f4"), Interface("x", (5, 6, 7), "<f4"), Interface(512, 5, "<f4")):
            self.assertIn("source has a __cuda_array_interface__ that is none (", self.refusal(interface))
        for device, begin in (((1, 0), "source has values that numpy does not read ("), ((2, 0), "source does not give its values (")):
            source = unittest.mock.Mock(spec=["__dlpack__", "__dlpack_device__"])
            source.__dlpack_device__ = lambda device=device: device
            source.__dlpack__ = lambda **_: 5
            self.assertIn(begin, self.refusal(source))
            source.__dlpack_device__ = lambda: 5
            self.assertIn("source does not say where its values lie (", self.refusal(source))


class Cuda:
    """The part of CUDA's runtime that copies values to a device. Raises OSError if there is no runtime."""

    def __init__(self):
        self._library = None
        for name in ("libcudart.so", "libcudart.so.13", "libcudart.so.12"):
            try:
                self._library = ctypes.CDLL(name)
                break
            except OSError:
                continue
        count = ctypes.c_int(0)
        if self._library is None or self._library.cudaGetDeviceCount(ctypes.byref(count)) != 0 or count.value == 0:
            raise OSError("no CUDA runtime, or no device")

    def put(self, values):
        address = ctypes.c_void_p()
        assert self._library.cudaMalloc(ctypes.byref(address), ctypes.c_size_t(values.nbytes)) == 0
        data = ctypes.c_void_p(values.ctypes.data)
        assert self._library.cudaMemcpy(address, data, ctypes.c_size_t(values.nbytes), 1) == 0
        return address.value


def cuda():
    try:
        return Cuda()
    except OSError:
        return None


def without_a_device():
    """Returns the messages about an array on a device that does not exist: of a build with CUDA, of one without."""
    return (
        "source lies on a CUDA device, and none answers here; copy it to a numpy array first",
        "source lies on a CUDA device, and this weir was built without CUDA; copy it to a numpy array first",
    )


class WithoutADevice(FolderTest):
    @unittest.skipIf(cuda() is not None, "there is a CUDA device")
    def test_an_array_on_a_device_is_refused(self):
        for source in (Tensor(4096, (5, 6, 7), None, 2, 32), Interface(4096, (5, 6, 7), "<f4")):
            with self.assertRaises(weir.UsageError) as raised:
                weir.convert(source, self.folder / "a.nvdb")
            self.assertIn(str(raised.exception), without_a_device())
            self.assertEqual(self.names(), [])


@unittest.skipIf(cuda() is None, "there is no CUDA device")
class OnADevice(FolderTest):
    def setUp(self):
        super().setUp()
        self.cuda = Cuda()

    def same_file(self, values, source, **options):
        weir.convert(numpy.ascontiguousarray(values), self.folder / "numpy.nvdb", **options)
        weir.convert(source, self.folder / "device.nvdb", **options)
        self.assertEqual((self.folder / "device.nvdb").read_bytes(), (self.folder / "numpy.nvdb").read_bytes())
        for name in self.names():
            (self.folder / name).unlink()

    def test_files_have_the_bytes_of_the_same_array_in_the_hosts_memory(self):
        for options in ({"rate": 6}, {"rate": 6, "encoding": "packed", "memory": "2GiB"}, {"lossless": True},
                        {"encoding": "packed", "memory": "2GiB", "psnr": 60, "backend": "cuda"}):
            for kind in ("float32", "float64", "int16", "uint8"):
                with self.subTest(options=options, type=kind):
                    values = noise((130, 96, 140), numpy.dtype(kind))
                    letter = values.dtype.kind
                    address = self.cuda.put(values)
                    self.same_file(values, Interface(address, values.shape, values.dtype.str), **options)
                    bits = 8 * values.itemsize
                    self.same_file(values, Tensor(address, values.shape, None, _DL_NAMES[letter], bits), **options)

    def test_strides_are_followed(self):
        values = noise((130, 96, 140), numpy.float32)
        address = self.cuda.put(values)
        part = values[::-1, 3:60, ::2]
        first = address + part.ctypes.data - values.ctypes.data
        self.same_file(part, Interface(first, part.shape, "<f4", strides=part.strides), rate=4)
        turned = values.transpose(2, 1, 0)
        self.same_file(turned, Interface(address, turned.shape, "<f4", strides=turned.strides), rate=4)

    def test_an_address_of_the_host_is_refused(self):
        values = noise((9, 9, 9), numpy.float32)
        with self.assertRaisesRegex(weir.UsageError, "source says that it lies on a CUDA device, and its address is no memory of one"):
            weir.convert(Interface(values.ctypes.data, values.shape, "<f4"), self.folder / "a.nvdb")


if __name__ == "__main__":
    unittest.main()
