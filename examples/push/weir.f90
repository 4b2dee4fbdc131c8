! weir.h for Fortran 2008: what converts, pushes and reads. weir.h says what each call does, and what its arguments are;
! text arguments end with c_null_char.
module weir
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int32_t), parameter :: weir_ok = 0, weir_float32 = 10, weir_float64 = 11
  integer(c_int32_t), parameter :: weir_budget_auto = 0, weir_budget_rate = 1, weir_budget_size = 2, &
                                   weir_budget_psnr = 3, weir_budget_max_error = 4, weir_budget_lossless = 5
  integer(c_int32_t), parameter :: weir_missing_policy_auto = 0, weir_missing_policy_error = 1, &
                                   weir_missing_policy_background = 2, weir_missing_policy_keep = 3
  integer(c_int32_t), parameter :: weir_filter_nearest = 0, weir_filter_trilinear = 1

  type, bind(c) :: weir_error
    integer(c_int32_t) :: status
    character(kind=c_char) :: message(2044)
  end type

  type, bind(c) :: weir_volume
    integer(c_size_t) :: struct_size
    integer(c_int64_t) :: extent(3)
    real(c_double) :: spacing(3), origin(3)
    type(c_ptr) :: name, missing
    integer(c_int32_t) :: scalar_type, reserved
  end type

  type, bind(c) :: weir_convert_options
    integer(c_size_t) :: struct_size
    real(c_double) :: budget
    integer(c_int64_t) :: file_size, memory
    type(c_ptr) :: work_dir
    type(c_funptr) :: progress, cancel, notice
    type(c_ptr) :: user
    integer(c_int32_t) :: budget_kind, encoding, metric, brick, fill, nonfinite, has_background
    real(c_float) :: background
    integer(c_int32_t) :: overwrite, threads
    integer(c_int32_t) :: preview, missing_policy, at_most, backend, certify, reserved
  end type

  interface
    integer(c_int32_t) function weir_volume_init(volume, struct_size) bind(c)
      import
      type(weir_volume), intent(out) :: volume
      integer(c_size_t), value :: struct_size
    end function

    integer(c_int32_t) function weir_convert_options_init(options, struct_size) bind(c)
      import
      type(weir_convert_options), intent(out) :: options
      integer(c_size_t), value :: struct_size
    end function

    integer(c_int32_t) function weir_convert(volume, values, stride, options, output, error) bind(c)
      import
      type(weir_volume), intent(in) :: volume
      type(c_ptr), value :: values, stride
      type(weir_convert_options), intent(in) :: options
      character(kind=c_char), intent(in) :: output(*)
      type(weir_error), intent(out) :: error
    end function

    integer(c_int32_t) function weir_push_begin(volume, options, output, push, error) bind(c)
      import
      type(weir_volume), intent(in) :: volume
      type(weir_convert_options), intent(in) :: options
      character(kind=c_char), intent(in) :: output(*)
      type(c_ptr), intent(out) :: push
      type(weir_error), intent(out) :: error
    end function

    integer(c_int32_t) function weir_push_slab(push, z0, nz, values, stride, error) bind(c)
      import
      type(c_ptr), value :: push, values, stride
      integer(c_int64_t), value :: z0, nz
      type(weir_error), intent(out) :: error
    end function

    integer(c_int32_t) function weir_push_end(push, error) bind(c)
      import
      type(c_ptr), value :: push
      type(weir_error), intent(out) :: error
    end function

    subroutine weir_push_free(push) bind(c)
      import
      type(c_ptr), value :: push
    end subroutine

    integer(c_int32_t) function weir_open(path, grid, error) bind(c)
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(out) :: grid
      type(weir_error), intent(out) :: error
    end function

    subroutine weir_close(grid) bind(c)
      import
      type(c_ptr), value :: grid
    end subroutine

    integer(c_int32_t) function weir_sample(grid, filter, positions, count, values, error) bind(c)
      import
      type(c_ptr), value :: grid
      integer(c_int32_t), value :: filter
      real(c_float), intent(in) :: positions(3, *)
      integer(c_size_t), value :: count
      real(c_float), intent(out) :: values(*)
      type(weir_error), intent(out) :: error
    end function
  end interface

contains

  ! The line that says what went wrong.
  function weir_message(error) result(line)
    type(weir_error), intent(in) :: error
    character(len=:), allocatable :: line
    integer :: i

    line = ''
    do i = 1, size(error%message)
      if (error%message(i) == c_null_char) exit
      line = line // error%message(i)
    end do
  end function
end module
