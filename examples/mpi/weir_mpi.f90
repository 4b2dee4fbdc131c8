! weir_mpi.h for Fortran 2008, beside the module of weir.f90 (examples/push). weir_mpi.h says what each call does, and
! what its arguments are.
module weir_mpi
  use, intrinsic :: iso_c_binding
  use weir
  implicit none
  public

  interface
    ! `comm` is the communicator of the modules mpi and mpif.h, or of mpi_f08 its member mpi_val.
    integer(c_int32_t) function weir_mpi_push_begin_fortran(comm, volume, options, output, push, error) bind(c)
      import
      integer(c_int), value :: comm
      type(weir_volume), intent(in) :: volume
      type(weir_convert_options), intent(in) :: options
      character(kind=c_char), intent(in) :: output(*)
      type(c_ptr), intent(out) :: push
      type(weir_error), intent(out) :: error
    end function

    ! `lo` begins at 0, as in C.
    integer(c_int32_t) function weir_mpi_push_box(push, lo, extent, values, stride, error) bind(c)
      import
      type(c_ptr), value :: push
      integer(c_int64_t), intent(in) :: lo(3), extent(3)
      type(c_ptr), value :: values, stride
      type(weir_error), intent(out) :: error
    end function

    integer(c_int32_t) function weir_mpi_push_end(push, error) bind(c)
      import
      type(c_ptr), value :: push
      type(weir_error), intent(out) :: error
    end function

    subroutine weir_mpi_push_free(push) bind(c)
      import
      type(c_ptr), value :: push
    end subroutine
  end interface
end module
