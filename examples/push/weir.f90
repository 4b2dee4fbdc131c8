! weir.h for Fortran 2008: all of its types, constants and calls. weir.h says what each call does, and what its
! arguments are. Members have its names, but for `file_size` (size) and `scalar_type` (type). Text arguments end with
! c_null_char; what may be NULL there and is a type(c_ptr) here may be c_null_ptr. Options are always given, as their
! _init sets them up.
module weir
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int32_t), parameter :: weir_ok = 0, weir_error_internal = 1, weir_error_usage = 2, weir_error_input = 3, &
                                   weir_error_budget = 4, weir_error_io = 5, weir_interrupted = 130
  integer(c_int32_t), parameter :: weir_uint8 = 1, weir_int8 = 2, weir_uint16 = 3, weir_int16 = 4, weir_uint32 = 5, &
                                   weir_int32 = 6, weir_uint64 = 7, weir_int64 = 8, weir_float16 = 9, &
                                   weir_float32 = 10, weir_float64 = 11, weir_bfloat16 = 12
  integer(c_int32_t), parameter :: weir_budget_auto = 0, weir_budget_rate = 1, weir_budget_size = 2, &
                                   weir_budget_psnr = 3, weir_budget_max_error = 4, weir_budget_lossless = 5
  integer(c_int32_t), parameter :: weir_encoding_auto = 0, weir_encoding_float = 1, weir_encoding_fpn = 2, &
                                   weir_encoding_fp4 = 3, weir_encoding_fp8 = 4, weir_encoding_fp16 = 5, &
                                   weir_encoding_packed = 6
  integer(c_int32_t), parameter :: weir_preview_auto = 0, weir_preview_on = 1, weir_preview_off = 2
  integer(c_int32_t), parameter :: weir_backend_auto = 0, weir_backend_cpu = 1, weir_backend_cuda = 2
  integer(c_int32_t), parameter :: weir_metric_sse = 0, weir_metric_farthest = 1, weir_metric_closest = 2, &
                                   weir_metric_median = 3
  integer(c_int32_t), parameter :: weir_fill_mean = 0, weir_fill_background = 1
  integer(c_int32_t), parameter :: weir_certify_values = 0, weir_certify_gradient = 1
  integer(c_int32_t), parameter :: weir_nonfinite_error = 0, weir_nonfinite_background = 1, weir_nonfinite_keep = 2
  integer(c_int32_t), parameter :: weir_missing_policy_auto = 0, weir_missing_policy_error = 1, &
                                   weir_missing_policy_background = 2, weir_missing_policy_keep = 3
  integer(c_int32_t), parameter :: weir_endian_auto = 0, weir_endian_little = 1, weir_endian_big = 2
  integer(c_int32_t), parameter :: weir_levels_composite = 0, weir_levels_separate = 1
  integer(c_int32_t), parameter :: weir_upsample_constant = 0, weir_upsample_linear = 1
  integer(c_int32_t), parameter :: weir_missing_chunks_fill = 0, weir_missing_chunks_error = 1
  integer(c_int32_t), parameter :: weir_filter_nearest = 0, weir_filter_trilinear = 1

  integer, parameter :: weir_message_bytes = 2044

  type, bind(c) :: weir_error
    integer(c_int32_t) :: status
    character(kind=c_char) :: message(weir_message_bytes)
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

  type, bind(c) :: weir_input_options
    integer(c_size_t) :: struct_size
    integer(c_int64_t) :: extent(3), offset
    type(c_ptr) :: dataset, index
    integer(c_size_t) :: index_count
    type(c_ptr) :: missing
    real(c_double) :: spacing(3), origin(3)
    integer(c_int64_t) :: roi_min(3), roi_max(3)
    integer(c_int32_t) :: scalar_type, endian, has_origin, stack
    type(c_ptr) :: component
    integer(c_int64_t) :: ghost(3)
    integer(c_int32_t) :: level, has_level, upsample, missing_chunks
    type(c_ptr) :: magnitude
    integer(c_int32_t) :: levels, reserved
  end type

  type, bind(c) :: weir_grid_info
    integer(c_size_t) :: struct_size
    integer(c_int64_t) :: extent(3), index_min(3)
    real(c_double) :: spacing(3), origin(3), range(2), background
    integer(c_int64_t) :: file_bytes, grid_offset, grid_bytes, data_bytes
    real(c_double) :: psnr_db, mse, max_abs_error, source_range(2)
    integer(c_int64_t) :: nonfinite, missing
    integer(c_int32_t) :: certified, lossless, encoding, reserved
  end type

  ! Procedures of a module, whose c_funloc is for the members progress, cancel and notice. `pass` and `line` are for
  ! weir_text.
  abstract interface
    subroutine weir_progress(user, pass, done_bytes, total_bytes) bind(c)
      import
      type(c_ptr), value :: user, pass
      integer(c_int64_t), value :: done_bytes, total_bytes
    end subroutine

    integer(c_int) function weir_cancel(user) bind(c)
      import
      type(c_ptr), value :: user
    end function

    subroutine weir_notice(user, line) bind(c)
      import
      type(c_ptr), value :: user, line
    end subroutine
  end interface

  interface
    ! For weir_text, as all of type(c_ptr) that stands for text.
    type(c_ptr) function weir_version() bind(c)
      import
    end function

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

    integer(c_int32_t) function weir_convert_to_memory(volume, values, stride, options, buffer, error) bind(c)
      import
      type(weir_volume), intent(in) :: volume
      type(c_ptr), value :: values, stride
      type(weir_convert_options), intent(in) :: options
      type(c_ptr), intent(out) :: buffer
      type(weir_error), intent(out) :: error
    end function

    type(c_ptr) function weir_buffer_data(buffer) bind(c)
      import
      type(c_ptr), value :: buffer
    end function

    integer(c_int64_t) function weir_buffer_size(buffer) bind(c)
      import
      type(c_ptr), value :: buffer
    end function

    type(c_ptr) function weir_buffer_sidecar(buffer) bind(c)
      import
      type(c_ptr), value :: buffer
    end function

    subroutine weir_buffer_free(buffer) bind(c)
      import
      type(c_ptr), value :: buffer
    end subroutine

    integer(c_int32_t) function weir_input_options_init(options, struct_size) bind(c)
      import
      type(weir_input_options), intent(out) :: options
      integer(c_size_t), value :: struct_size
    end function

    integer(c_int32_t) function weir_convert_file(input, input_options, options, output, error) bind(c)
      import
      character(kind=c_char), intent(in) :: input(*)
      type(weir_input_options), intent(in) :: input_options
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

    integer(c_int32_t) function weir_open_memory(file, bytes, sidecar, grid, error) bind(c)
      import
      type(c_ptr), value :: file
      integer(c_int64_t), value :: bytes
      type(c_ptr), value :: sidecar
      type(c_ptr), intent(out) :: grid
      type(weir_error), intent(out) :: error
    end function

    subroutine weir_close(grid) bind(c)
      import
      type(c_ptr), value :: grid
    end subroutine

    integer(c_int32_t) function weir_grid_info_init(info, struct_size) bind(c)
      import
      type(weir_grid_info), intent(out) :: info
      integer(c_size_t), value :: struct_size
    end function

    integer(c_int32_t) function weir_get_info(grid, info, error) bind(c)
      import
      type(c_ptr), value :: grid
      type(weir_grid_info), intent(inout) :: info
      type(weir_error), intent(out) :: error
    end function

    type(c_ptr) function weir_grid_name(grid) bind(c)
      import
      type(c_ptr), value :: grid
    end function

    type(c_ptr) function weir_grid_sidecar(grid) bind(c)
      import
      type(c_ptr), value :: grid
    end function

    type(c_ptr) function weir_grid_data(grid) bind(c)
      import
      type(c_ptr), value :: grid
    end function

    ! Indices begin at 0, as in C, here and in weir_read_box.
    integer(c_int32_t) function weir_value(grid, index, value, error) bind(c)
      import
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(in) :: index(3)
      real(c_float), intent(out) :: value
      type(weir_error), intent(out) :: error
    end function

    integer(c_int32_t) function weir_read_box(grid, min, max, values, count, error) bind(c)
      import
      type(c_ptr), value :: grid
      integer(c_int64_t), intent(in) :: min(3), max(3)
      real(c_float), intent(out) :: values(*)
      integer(c_size_t), value :: count
      type(weir_error), intent(out) :: error
    end function

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

  ! The text that a call returned, without its zero; '' where there is none.
  function weir_text(text) result(line)
    type(c_ptr), intent(in) :: text
    character(len=:), allocatable :: line
    character(kind=c_char), pointer :: letters(:)
    integer(c_size_t) :: length, i

    length = 0
    if (c_associated(text)) then
      call c_f_pointer(text, letters, [huge(1_c_int)])
      do while (letters(length + 1) /= c_null_char)
        length = length + 1
      end do
    end if
    allocate (character(len=length) :: line)
    do i = 1, length
      line(i:i) = letters(i)
    end do
  end function

  ! The line that says what went wrong.
  pure function weir_message(error) result(line)
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
